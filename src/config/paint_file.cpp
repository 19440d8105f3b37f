#include "config/paint_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <tuple>

#include "base/atomic_file.h"
#include "config/complaints.h"
#include "config/kinds.h"
#include "config/suggest.h"

namespace plisse::config {
namespace {

namespace fs = std::filesystem;
using config::Complaints;
using config::Problem;
using StrokeKind = PaintStroke::Kind;
using Mode = PaintStroke::Mode;

const std::vector<std::string>& kind_names() {  // in the order of PaintStroke::Kind
  static const std::vector<std::string> names = {"screen",  "surface", "uv",     "image",
                                                 "colours", "painted", "random", "fill"};
  return names;
}
const std::vector<StrokeKind> lines{StrokeKind::screen, StrokeKind::surface, StrokeKind::uv};
const std::vector<StrokeKind> everywhere{};

// |p| stays below 1; erasing, smoothing and what was painted before may be taken whole.
double most_strength(const PaintStroke& stroke) {
  return stroke.mode == Mode::paint && stroke.kind != StrokeKind::painted ? 0.99 : 1;
}

template <typename Value>
Value word_of(const toml::node& node, const config::Words<Value>& words) {
  const std::string given = config::text_of(node);
  std::vector<std::string> names;
  for (const auto& [name, meaning] : words) {
    if (name == given) return meaning;
    names.push_back(name);
  }
  throw config::unknown_word(given, names);
}

const toml::array& array_of(const toml::node& node, std::string_view wanted) {
  const toml::array* array = node.as_array();
  if (!array) throw Problem{fmt::format("this is no {}", wanted), ""};
  return *array;
}

glm::dvec3 vector_of(const toml::node& node) {
  const toml::array& array = array_of(node, "array of three numbers");
  if (array.size() != 3) throw Problem{fmt::format("{} numbers are no vector", array.size()), ""};
  glm::dvec3 result{0};
  for (int i = 0; i < 3; ++i) {
    result[i] = config::within(config::number_of(array[static_cast<std::size_t>(i)]), {-1e9, 1e9});
  }
  return result;
}

void set_points(PaintStroke& stroke, const toml::node& node, const fs::path&) {
  const bool flat = stroke.kind != StrokeKind::surface;
  for (const toml::node& item : array_of(node, "array of points")) {
    const toml::array& array = array_of(item, "point");
    const std::size_t wanted = flat ? 2 : 3;
    if (array.size() != wanted)
      throw Problem{fmt::format("a point of {} numbers, not of {}", array.size(), wanted), ""};
    glm::dvec3 point{0};
    for (std::size_t i = 0; i < wanted; ++i) {
      const double value = flat ? config::number_of(array[i]) : config::length_of(array[i]);
      point[static_cast<int>(i)] = config::within(value, {-1e9, 1e9});
    }
    stroke.points.push_back(point);
  }
  if (stroke.points.empty()) throw Problem{"there is no point in it", ""};
}

void set_direction(PaintStroke& stroke, const toml::node& node, const fs::path&) {
  using D = PaintDirection::Kind;
  PaintDirection& direction = stroke.direction;
  if (node.is_number()) {
    direction = {D::angle, config::within(config::number_of(node), {-360, 360}), {}};
  } else if (node.is_array()) {
    direction = {D::vector, 0, vector_of(node)};
    if (direction.vector == glm::dvec3(0)) throw Problem{"the vector has no length", ""};
  } else {
    direction.kind = word_of<D>(node, {{"across", D::across}, {"along", D::along}, {"random", D::random}});
  }
}

constexpr config::Range lengths{1e-9, 1e9};

struct StrokeKey {
  std::string name;
  std::vector<StrokeKind> kinds;  // empty: all
  std::string allowed, doc;
  std::function<void(PaintStroke&, const toml::node&, const fs::path& folder)> set;
};

const std::vector<StrokeKey>& stroke_keys() {
  using Stroke = PaintStroke;
  using Node = toml::node;
  using Path = fs::path;
  static const std::vector<StrokeKey> keys = {
      {"kind", everywhere, config::either(kind_names()), "Where the stroke is given; must be there.",
       [](Stroke& s, const Node& n, const Path&) {
         config::Words<StrokeKind> words;
         for (std::size_t i = 0; i < kind_names().size(); ++i)
           words.emplace_back(kind_names()[i], static_cast<StrokeKind>(i));
         s.kind = word_of<StrokeKind>(n, words);
       }},
      {"mode", everywhere, "paint, erase or smooth",
       "Lay wrinkles (paint), take them away (erase), or even them out with their neighbours (smooth).",
       [](Stroke& s, const Node& n, const Path&) {
         s.mode =
             word_of<Mode>(n, {{"paint", Mode::paint}, {"erase", Mode::erase}, {"smooth", Mode::smooth}});
       }},
      {"strength", everywhere, "0 … 0.99 (erase, smooth, painted: 0 … 1)",
       "Length of the vector p in the middle of the stroke (default 0.45): cloth is shortened by its square. "
       "With erase "
       "and smooth, how much of it is done (default 1).",
       [](Stroke& s, const Node& n, const Path&) {
         s.strength = config::within(config::number_of(n), {0, most_strength(s)});
       }},
      {"direction", everywhere,
       "across, along, random, an angle in degrees, or a vector [x, y, z] of the rest pose",
       "The way in which cloth is gathered; folds run at right angles to it. across (the default of lines) "
       "and along "
       "refer to the line; angles turn counterclockwise from the picture's right (screen) or from growing u; "
       "random is "
       "for kind random, its default.",
       set_direction},
      {"only", everywhere, "a text or an array of texts",
       "Meshes or materials that it touches; none named: all.",
       [](Stroke& s, const Node& n, const Path&) { s.only = config::names_of(n); }},
      {"exclude", everywhere, "a text or an array of texts", "Meshes or materials that it leaves alone.",
       [](Stroke& s, const Node& n, const Path&) { s.exclude = config::names_of(n); }},
      {"rounds", everywhere, "1 … 1000", "How often a stroke with mode smooth is repeated (default 1).",
       [](Stroke& s, const Node& n, const Path&) {
         s.rounds = static_cast<int>(config::within(static_cast<double>(config::whole_of(n)), {1, 1000}));
       }},
      {"points", lines, "an array of points",
       "The line: [x, y] in pixels from the picture's upper left (screen), [x, y, z] lengths in the rest "
       "pose (surface), "
       "[u, v] (uv). One point is a dab.",
       set_points},
      {"vertices",
       {StrokeKind::surface},
       "an array of welded vertex numbers, from 0",
       "The line by vertices, in place of points.",
       [](Stroke& s, const Node& n, const Path&) {
         for (const Node& item : array_of(n, "array of numbers")) {
           s.vertices.push_back(static_cast<std::uint32_t>(
               config::within(static_cast<double>(config::whole_of(item)), {0, 4294967295.0})));
         }
         if (s.vertices.empty()) throw Problem{"there is no vertex in it", ""};
       }},
      {"radius",
       {StrokeKind::screen, StrokeKind::surface, StrokeKind::uv, StrokeKind::random},
       config::range_text(lengths),
       "How far from the line it reaches: pixels (screen), a length (surface, random), units of uv. Must be "
       "there.",
       [](Stroke& s, const Node& n, const Path&) {
         s.radius = config::within(config::length_of(n), lengths);
       }},
      {"falloff",
       {StrokeKind::screen, StrokeKind::surface, StrokeKind::uv, StrokeKind::random},
       "smooth, linear or flat",
       "How it fades toward the radius.",
       [](Stroke& s, const Node& n, const Path&) {
         using F = Stroke::Falloff;
         s.falloff = word_of<F>(n, {{"smooth", F::smooth}, {"linear", F::linear}, {"flat", F::flat}});
       }},
      {"frame",
       {StrokeKind::screen},
       "a frame from 1",
       "The frame in whose picture the line is drawn (default 1).",
       [](Stroke& s, const Node& n, const Path&) {
         s.frame = static_cast<int>(config::within(static_cast<double>(config::whole_of(n)), {1, 1e9}));
       }},
      {"camera",
       {StrokeKind::screen},
       "a camera as --camera takes it",
       "Another camera than the scene's.",
       [](Stroke& s, const Node& n, const Path&) { s.camera = config::text_of(n); }},
      {"size",
       {StrokeKind::screen},
       "\"WxH\" or [W, H]",
       "The picture's size where it is not the scene's.",
       [](Stroke& s, const Node& n, const Path&) { std::tie(s.width, s.height) = config::size_of(n); }},
      {"file",
       {StrokeKind::image, StrokeKind::colours, StrokeKind::painted},
       "an existing file",
       "A picture in uv whose brightness times alpha is the amount (image); a PLY with red, green, blue, "
       "whose "
       "brightness is the amount (colours); a PLY or PNG that plisse painted (painted).",
       [](Stroke& s, const Node& n, const Path& folder) { s.file = config::existing_file(n, folder); }},
      {"up",
       {StrokeKind::colours},
       "x, y or z",
       "The axis that points up in the file (default y; Blender writes z).",
       [](Stroke& s, const Node& n, const Path&) {
         s.up = word_of<std::string>(n, {{"x", "x"}, {"y", "y"}, {"z", "z"}});
       }},
      {"seed",
       {StrokeKind::random},
       "0 … 4294967295",
       "Another seed, other wrinkles.",
       [](Stroke& s, const Node& n, const Path&) {
         s.seed = static_cast<std::uint32_t>(
             config::within(static_cast<double>(config::whole_of(n)), {0, 4294967295.0}));
       }},
      {"density",
       {StrokeKind::random},
       "1e-09 … 1e+09",
       "Wrinkles per square metre. Must be there.",
       [](Stroke& s, const Node& n, const Path&) {
         s.density = config::within(config::number_of(n), lengths);
       }},
      {"length",
       {StrokeKind::random},
       config::range_text(lengths),
       "Length of each fold. Must be there.",
       [](Stroke& s, const Node& n, const Path&) {
         s.length = config::within(config::length_of(n), lengths);
       }},
  };
  return keys;
}

bool fits(const StrokeKey& key, StrokeKind kind) {
  return key.kinds.empty() || std::find(key.kinds.begin(), key.kinds.end(), kind) != key.kinds.end();
}

std::vector<std::string> keys_of(StrokeKind kind) {
  std::vector<std::string> names;
  for (const StrokeKey& key : stroke_keys()) {
    if (fits(key, kind)) names.push_back(key.name);
  }
  return names;
}

// Reads one key of a table; what is wrong goes to the complaints.
void read_key(const toml::key& key, const std::string& allowed, Complaints& complaints,
              const std::function<void()>& set) {
  try {
    set();
  } catch (const Problem& problem) {
    complaints.add(key.source().begin, fmt::format("key '{}': {}; allowed: {}{}", key.str(), problem.what,
                                                   allowed, problem.hint));
  }
}

void check_complete(const PaintStroke& stroke, const std::set<std::string>& given,
                    const toml::source_position& at, Complaints& complaints) {
  const std::string& kind = kind_names()[static_cast<std::size_t>(stroke.kind)];
  const auto need = [&](std::string_view name) {
    if (!given.count(std::string(name)))
      complaints.add(at, fmt::format("key '{}': missing, a stroke of kind {} needs it", name, kind));
  };
  using D = PaintDirection::Kind;
  switch (stroke.kind) {
    case StrokeKind::surface:
      if (given.count("points") == given.count("vertices"))
        complaints.add(at, "a stroke of kind surface needs either 'points' or 'vertices'");
      need("radius");
      break;
    case StrokeKind::screen:
    case StrokeKind::uv:
      need("points");
      need("radius");
      break;
    case StrokeKind::image:
    case StrokeKind::colours:
    case StrokeKind::painted:
      need("file");
      break;
    case StrokeKind::random:
      need("density");
      need("length");
      need("radius");
      break;
    case StrokeKind::fill:
      break;
  }
  const D direction = stroke.direction.kind;
  const bool line = std::find(lines.begin(), lines.end(), stroke.kind) != lines.end();
  const bool needs_direction = stroke.mode == Mode::paint && stroke.kind != StrokeKind::painted;
  if (!needs_direction) {
    if (given.count("direction"))
      complaints.add(at, "key 'direction': has no effect on this stroke; take it out");
    return;
  }
  if (direction == D::random && stroke.kind != StrokeKind::random)
    complaints.add(at, "key 'direction': random is for strokes of kind random");
  if (line && stroke.points.size() + stroke.vertices.size() == 1 &&
      (direction == D::across || direction == D::along))
    complaints.add(at, "key 'direction': one point is no line; give an angle or a vector");
  if (!line && stroke.kind != StrokeKind::random && (direction == D::across || direction == D::along))
    complaints.add(at, fmt::format("key 'direction': a stroke of kind {} needs an angle or a vector", kind));
}

PaintStroke read_stroke(const toml::table& table, const fs::path& file, Complaints& complaints) {
  PaintStroke stroke;
  const toml::source_position at = table.source().begin;
  stroke.place = config::place_in(file, at);
  if (!table.contains("kind")) {
    complaints.add(at, fmt::format("key 'kind': missing; allowed: {}", config::either(kind_names())));
    return stroke;
  }
  // What the other keys mean depends on these two.
  for (const StrokeKey& key : {stroke_keys()[0], stroke_keys()[1]}) {
    const toml::node* node = table.get(key.name);
    if (!node) continue;
    try {
      key.set(stroke, *node, {});
    } catch (const Problem& problem) {
      complaints.add(node->source().begin, fmt::format("key '{}': {}; allowed: {}{}", key.name, problem.what,
                                                       key.allowed, problem.hint));
      return stroke;
    }
  }
  if (stroke.kind == StrokeKind::random) stroke.direction.kind = PaintDirection::Kind::random;
  if (most_strength(stroke) == 1) stroke.strength = 1;
  std::set<std::string> given;
  for (const auto& [toml_key, node] : table) {
    const std::string name(toml_key.str());
    if (name == "kind" || name == "mode") continue;
    const auto found = std::find_if(stroke_keys().begin(), stroke_keys().end(),
                                    [&](const StrokeKey& key) { return key.name == name; });
    if (found == stroke_keys().end() || !fits(*found, stroke.kind)) {
      const auto names = keys_of(stroke.kind);
      complaints.add(toml_key.source().begin,
                     fmt::format("key '{}': unknown in a stroke of kind {}; allowed: {}{}", name,
                                 kind_names()[static_cast<std::size_t>(stroke.kind)], config::either(names),
                                 did_you_mean(name, names)));
      continue;
    }
    given.insert(name);
    read_key(toml_key, found->allowed, complaints,
             [&, &value = node] { found->set(stroke, value, file.parent_path()); });
  }
  check_complete(stroke, given, at, complaints);
  return stroke;
}

struct RootKey {
  std::string name, allowed, doc;
  std::function<void(PaintSettings&, const toml::node&, const fs::path& folder)> set;
};

const std::vector<RootKey>& root_keys() {
  static const std::vector<RootKey> keys = {
      {"scene", "an existing scene or model",
       "What is painted on: rest pose, selection, and the camera of screen strokes. A scene's own [bias] is "
       "left out. Not "
       "needed where a scene's [bias] names this file.",
       [](PaintSettings& s, const toml::node& n, const fs::path& folder) {
         s.scene = config::existing_file(n, folder);
       }},
      {"texture_size", "16 … 16384", "Side of the uv texture in texels (default 1024).",
       [](PaintSettings& s, const toml::node& n, const fs::path&) {
         s.texture_size =
             static_cast<int>(config::within(static_cast<double>(config::whole_of(n)), {16, 16384}));
       }},
      {"preview_frame", "a frame from 1; 0: no preview",
       "The frame that is drawn as preview.png (default 1).",
       [](PaintSettings& s, const toml::node& n, const fs::path&) {
         s.preview_frame =
             static_cast<int>(config::within(static_cast<double>(config::whole_of(n)), {0, 1e9}));
       }},
  };
  return keys;
}

}  // namespace

PaintSettings parse_paint(std::string_view text, const fs::path& file) {
  const toml::table root = config::parse_toml(text, file);
  Complaints complaints(file);
  PaintSettings settings;
  settings.file = file;
  for (const auto& [toml_key, node] : root) {
    const std::string name(toml_key.str());
    if (name == "stroke") {
      const toml::array* strokes = node.as_array();
      if (!strokes) {
        complaints.add(toml_key.source().begin,
                       "key 'stroke': write [[stroke]] and its keys below, once a stroke");
        continue;
      }
      for (const toml::node& item : *strokes) {
        if (const toml::table* table = item.as_table()) {
          settings.strokes.push_back(read_stroke(*table, file, complaints));
        } else {
          complaints.add(item.source().begin,
                         "key 'stroke': write [[stroke]] and its keys below, once a stroke");
        }
      }
      continue;
    }
    const auto found = std::find_if(root_keys().begin(), root_keys().end(),
                                    [&](const RootKey& key) { return key.name == name; });
    if (found == root_keys().end()) {
      std::vector<std::string> names;
      for (const RootKey& key : root_keys()) names.push_back(key.name);
      names.emplace_back("[[stroke]]");
      complaints.add(toml_key.source().begin, fmt::format("key '{}': unknown; allowed: {}{}", name,
                                                          config::either(names), did_you_mean(name, names)));
      continue;
    }
    read_key(toml_key, found->allowed, complaints,
             [&, &value = node] { found->set(settings, value, file.parent_path()); });
  }
  if (settings.strokes.empty() && !root.contains("stroke"))
    complaints.add({1, 1}, "there is no [[stroke]] in it");
  complaints.throw_if_any();
  return settings;
}

PaintSettings load_paint(const fs::path& file) {
  return parse_paint(read_whole_text(file), file);
}

std::vector<PaintKey> paint_keys() {
  std::vector<PaintKey> all;
  for (const RootKey& key : root_keys()) all.push_back({key.name, "file", key.allowed, key.doc});
  for (const StrokeKey& key : stroke_keys()) {
    std::string kinds;
    for (const StrokeKind kind : key.kinds)
      kinds += (kinds.empty() ? "" : ", ") + kind_names()[static_cast<std::size_t>(kind)];
    all.push_back({key.name, kinds.empty() ? "all" : kinds, key.allowed, key.doc});
  }
  return all;
}

std::string paint_reference_markdown() {
  std::string text = "| key | of | allowed | what it does |\n|---|---|---|---|\n";
  for (const PaintKey& key : paint_keys()) {
    text += fmt::format("| `{}` | {} | {} | {} |\n", key.name, key.kinds, key.allowed, key.doc);
  }
  return text;
}

}  // namespace plisse::config
