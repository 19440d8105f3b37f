#include "config/paint_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "base/atomic_file.h"
#include "config/file_reader.h"
#include "config/key_table.h"

namespace plisse::config {
namespace {

namespace fs = std::filesystem;
using StrokeKind = PaintStroke::Kind;
using Mode = PaintStroke::Mode;
using D = PaintDirection::Kind;

const Words<StrokeKind>& kinds() {
  static const Words<StrokeKind> words = {
      {"screen", StrokeKind::screen}, {"surface", StrokeKind::surface}, {"uv", StrokeKind::uv},
      {"image", StrokeKind::image},   {"colours", StrokeKind::colours}, {"painted", StrokeKind::painted},
      {"field", StrokeKind::field},   {"random", StrokeKind::random},   {"fill", StrokeKind::fill}};
  return words;
}

bool has_own_vectors(const PaintStroke& stroke) {
  return stroke.kind == StrokeKind::painted || stroke.kind == StrokeKind::field;
}

// |p| stays below 1; erasing, smoothing and what was painted before may be taken whole.
double most_strength(const PaintStroke& stroke) {
  return stroke.mode == Mode::paint && !has_own_vectors(stroke) ? 0.99 : 1;
}

void set_points(PaintStroke& stroke, const Given& given) {
  const bool flat = stroke.kind != StrokeKind::surface;
  const std::size_t wanted = flat ? 2 : 3;
  for (const toml::node& item : array_of(given, "list of points")) {
    const toml::array& array = array_of(given.part(item), "point");
    if (array.size() != wanted)
      throw Problem{fmt::format("a point of {} numbers, not of {}", array.size(), wanted)};
    glm::dvec3 point{0};
    for (std::size_t i = 0; i < wanted; ++i) {
      const Given number = given.part(array[i]);
      point[static_cast<int>(i)] = within(flat ? number_of(number) : length_of(number), {-1e9, 1e9});
    }
    stroke.points.push_back(point);
  }
}

void set_direction(PaintStroke& stroke, const Given& given) {
  PaintDirection& direction = stroke.direction;
  if (given.node.is_number()) {
    direction = {D::angle, within(number_of(given), {-360, 360}), {}};
  } else if (given.node.is_array()) {
    direction = {D::vector, 0, vector_of(given)};
    if (direction.vector == glm::dvec3(0)) throw Problem{"the vector has no length"};
  } else {
    direction.kind =
        enumeration<D>({{"across", D::across}, {"along", D::along}, {"random", D::random}}).read(given);
  }
}

constexpr Range lengths{1e-9, 1e9};

const Keys<PaintStroke>& stroke_keys() {
  using S = PaintStroke;
  using F = PaintStroke::Falloff;
  static const auto keys = keys_of<S>("stroke", [](auto& row) {
    const KeyExtras screen{.of = {"screen"}}, of_random{.of = {"random"}, .needed = always};
    const std::vector<std::string> round = {"screen", "surface", "uv", "random"};
    row("kind", &S::kind, enumeration(kinds()), "Where the stroke is given; must be there.",
        {.needed = always, .first = true});
    row("mode", &S::mode,
        enumeration<Mode>({{"paint", Mode::paint}, {"erase", Mode::erase}, {"smooth", Mode::smooth}}),
        "Lay wrinkles (paint), take them away (erase), or even them out with their neighbours (smooth).",
        {.first = true});
    row("strength", "0 … 0.99 (erase, smooth, painted, field: 0 … 1)",
        "Length of the vector p in the middle of the stroke (default 0.45): cloth is shortened by its "
        "square. With erase and smooth, how much of it is done; with painted and field, a factor (default "
        "1).",
        {}, [](S& s, const Given& given) {
          s.strength = within(number_of(given), {0, most_strength(s)});
        });
    row("direction", "across, along, random, an angle in degrees, or a vector [x, y, z] of the rest pose",
        "The way in which cloth is gathered; folds run at right angles to it. across (the default of lines) "
        "and along refer to the line; angles turn counterclockwise from the picture's right (screen) or from "
        "growing u; random is for kind random, its default.",
        {}, set_direction);
    row("only", &S::only, names(), "Meshes or materials that it touches; none named: all.");
    row("exclude", &S::exclude, names(), "Meshes or materials that it leaves alone.");
    row("rounds", &S::rounds, whole(1, 1000), "How often a stroke with mode smooth is repeated (default 1).");
    row("points", "an array of points",
        "The line: [x, y] in pixels from the picture's upper left (screen), [x, y, z] lengths in the rest "
        "pose (surface), [u, v] (uv). One point is a dab.",
        {.of = {"screen", "surface", "uv"}, .needed = {"screen", "uv"}}, set_points);
    row("vertices", &S::vertices, indices("an array of welded vertex numbers, from 0"),
        "The line by vertices, in place of points.", {.of = {"surface"}});
    row("radius", &S::radius, length(lengths).allowing(range_text(lengths)),
        "How far from the line it reaches: pixels (screen), a length (surface, random), units of uv. Must be "
        "there.",
        {.of = round, .needed = always});
    row("falloff", &S::falloff,
        enumeration<F>({{"smooth", F::smooth}, {"linear", F::linear}, {"flat", F::flat}}),
        "How it fades toward the radius.", {.of = round});
    row("frame", &S::frame, whole(1, 1000000000).allowing("a frame from 1"),
        "The frame in whose picture the line is drawn (default 1).", screen);
    row("camera", &S::camera, text().allowing("a camera as --camera takes it"),
        "Another camera than the scene's.", screen);
    row("size", picture_size().allowing("\"WxH\" or [W, H]"),
        "The picture's size where it is not the scene's.", screen,
        [](S& s, const std::pair<int, int>& size) { std::tie(s.width, s.height) = size; });
    row("file", &S::file, existing_file("an existing file"),
        "A picture in uv whose brightness times alpha is the amount (image); a PLY with red, green, blue, "
        "whose brightness is the amount (colours); a PLY or PNG that plisse painted (painted); a solved "
        "wrinkle "
        "field over the rest pose, as [bias] field takes it (field).",
        {.of = {"image", "colours", "painted", "field"}, .needed = always});
    row("up", &S::up, enumeration<std::string>({{"x", "x"}, {"y", "y"}, {"z", "z"}}),
        "The axis that points up in the file (default y; Blender writes z).", {.of = {"colours"}});
    row("seed", &S::seed, whole(0, 4294967295), "Another seed, other wrinkles.", {.of = {"random"}});
    row("density", &S::density, number(lengths), "Wrinkles per square metre. Must be there.", of_random);
    row("length", &S::length, length(lengths).allowing(range_text(lengths)),
        "Length of each fold. Must be there.", of_random);
  });
  return keys;
}

const Keys<PaintSettings>& root_keys() {
  using S = PaintSettings;
  static const auto keys = keys_of<S>("file", [](auto& row) {
    row("scene", &S::scene, existing_file("an existing scene or model"),
        "What is painted on: rest pose, selection, and the camera of screen strokes. A scene's own [bias] is "
        "left out. Not needed where a scene's [bias] names this file.");
    row("texture_size", &S::texture_size, whole(16, 16384),
        "Side of the uv texture in texels (default 1024).");
    row("preview_frame", &S::preview_frame, whole(0, 1000000000).allowing("a frame from 1; 0: no preview"),
        "The frame that is drawn as preview.png (default 1).");
  });
  return keys;
}

// Whether the direction goes with the rest of the stroke.
void check_direction(FileReader& reader, const PaintStroke& stroke, const Places& given,
                     const toml::source_position& at) {
  const D direction = stroke.direction.kind;
  const bool line = stroke.kind == StrokeKind::screen || stroke.kind == StrokeKind::surface ||
                    stroke.kind == StrokeKind::uv;
  if (stroke.mode != Mode::paint || has_own_vectors(stroke)) {
    if (given.contains("direction"))
      reader.complain(at, "key 'direction': has no effect on this stroke; take it out");
    return;
  }
  const bool of_line = direction == D::across || direction == D::along;
  if (direction == D::random && stroke.kind != StrokeKind::random)
    reader.complain(at, "key 'direction': random is for strokes of kind random");
  if (line && stroke.points.size() + stroke.vertices.size() == 1 && of_line)
    reader.complain(at, "key 'direction': one point is no line; give an angle or a vector");
  if (!line && stroke.kind != StrokeKind::random && of_line)
    reader.complain(at, fmt::format("key 'direction': a stroke of kind {} needs an angle or a vector",
                                    name_of(kinds(), stroke.kind)));
}

PaintStroke read_stroke(FileReader& reader, const toml::table& table) {
  PaintStroke stroke;
  const toml::source_position at = table.source().begin;
  stroke.place = reader.place(at);
  // What the other keys mean depends on kind and mode.
  if (!reader.read_first(stroke_keys(), table, "[[stroke]]", stroke)) return stroke;
  if (stroke.kind == StrokeKind::random) stroke.direction.kind = D::random;
  if (most_strength(stroke) == 1) stroke.strength = 1;
  const std::string kind = name_of(kinds(), stroke.kind);
  const Places given = reader.read(stroke_keys(), table, "a stroke of kind " + kind, stroke, kind);
  if (stroke.kind == StrokeKind::surface && given.contains("points") == given.contains("vertices"))
    reader.complain(at, "a stroke of kind surface needs either 'points' or 'vertices'");
  check_direction(reader, stroke, given, at);
  return stroke;
}

}  // namespace

PaintSettings parse_paint(std::string_view text, const fs::path& file) {
  FileReader reader(text, file);
  PaintSettings settings;
  settings.file = file;
  reader.read_root(root_keys(), settings,
                   {{"stroke", true, [&](const toml::table& table, const toml::source_position&) {
                       settings.strokes.push_back(read_stroke(reader, table));
                     }}});
  if (!reader.root().contains("stroke")) reader.complain({1, 1}, "there is no [[stroke]] in it");
  reader.finish();
  return settings;
}

PaintSettings load_paint(const fs::path& file) {
  return parse_paint(read_whole_text(file), file);
}

std::string paint_reference_markdown() {
  std::vector<KeyText> all;
  append(all, root_keys());
  append(all, stroke_keys());
  const Column of{"of", [](const KeyText& key) {
                    if (key.table == "file") return key.table;
                    return key.extras.of.empty() ? std::string("all") : either(key.extras.of, ", ", ", ");
                  }};
  return key_table(all, {name_column(), of, allowed_column(), doc_column()});
}

}  // namespace plisse::config
