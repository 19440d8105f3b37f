#include "config/drape_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>

#include "base/atomic_file.h"
#include "base/eigen_glm.h"
#include "config/fabric_key.h"
#include "config/file_reader.h"
#include "config/key_table.h"

namespace plisse::config {
namespace {

namespace fs = std::filesystem;
using Hold = DrapeSettings::Hold;
using Force = DrapeSettings::Force;
using Motion = DrapeSettings::Motion;
using Obstacle = DrapeSettings::Obstacle;
using Vector = glm::dvec3;

constexpr std::int64_t most_seed = 4294967295;

Kind<double> some_length() {
  return length({1e-9, 1e6}).allowing("a length");
}
Kind<std::array<Vector, 2>> box() {
  return {"box", "[[x, y, z], [x, y, z]]", [](const Given& given) {
            const toml::array& array = array_of(given, "pair of corners", 2);
            const Vector a = point_of(given.part(array[0])), b = point_of(given.part(array[1]));
            return std::array{glm::min(a, b), glm::max(a, b)};
          }};
}
Kind<std::vector<std::uint32_t>> vertices() {
  return indices("an array of vertex numbers, from 0");
}

// The kinds of obstacles for which `is` holds, by name.
std::vector<std::string> kind_names(const std::function<bool(const shell::ObstacleKind&)>& is) {
  std::vector<std::string> names;
  for (const shell::ObstacleKind& kind : shell::obstacle_kinds())
    if (is(kind)) names.emplace_back(kind.words.name);
  return names;
}
bool has_axis(const shell::ObstacleKind& kind) {
  return kind.words.axis;
}
bool has_radius(const shell::ObstacleKind& kind) {
  return kind.words.radius;
}
bool is_solid(const shell::ObstacleKind& kind) {
  return kind.make != nullptr;
}
bool is_mesh(const shell::ObstacleKind& kind) {
  return !is_solid(kind);
}
// "spheres, capsules and cylinders"
std::string plural(std::vector<std::string> names) {
  for (std::string& name : names) name += "s";
  return either(names, ", ", " and ");
}
Words<const shell::ObstacleKind*> obstacle_words() {
  Words<const shell::ObstacleKind*> words;
  for (const shell::ObstacleKind& kind : shell::obstacle_kinds()) words.push_back({kind.words.name, &kind});
  return words;
}

// What a weight is, per volume or per area.
void set_density(DrapeSettings& s, const Given& given) {
  if (!given.node.is_string()) {
    s.density = within(number_of(given), {0, 1e6});
    return;
  }
  const std::string text = text_of(given);
  const auto weight = sizing::parse_density(text);
  if (text.find_first_not_of("0123456789.eE+- ") == std::string::npos)
    throw Problem{fmt::format("'{}' has no unit; as a number it is kg/m³", text)};
  if (!weight) throw Problem{fmt::format("'{}' is no weight", text)};
  s.weight = within(*weight, {0, 1e3});
}

template <typename Item>
void add_motion(Keys<Item>& keys, const std::string& table, const std::string& who) {
  Rows<Item, Motion> row(keys, table, [](Item& item) -> Motion& { return item.motion; });
  row("move", &Motion::move, point(), fmt::format("How far {} taken at full load.", who));
  row("turn", &Motion::turn, number({-36000, 36000}),
      fmt::format("By how many degrees {} turned at full load, before {} moved.", who, who));
  row("axis", &Motion::axis, direction(), "The axis of the turn (default [0, 1, 0]).");
  row("point", &Motion::point, point(), "A point on it (default the origin).");
}

const Keys<DrapeSettings>& drape_keys() {
  using S = DrapeSettings;
  static const auto keys = keys_of<S>("drape", [](auto& row) {
    row("mesh", &S::mesh, existing_file("an existing OBJ"),
        "The rest shape, flat or not. Either this, `garment` or `panel`.");
    row("garment", &S::garment, existing_file("an existing panel file"),
        "Panels with seams (docs/sizing.md): sewn, placed as they say there, their x from right to left of "
        "who wears them.");
    row("wrap", &S::wrap, some_length(),
        "Bends each of a garment's panels round an upright cylinder of this radius before it is placed, x = "
        "0 in front.");
    row("pieces", &S::pieces, names(),
        "Of a garment: these panels alone, by name, and the seams between them (default: all).");
    row("panel", "[width, height], lengths",
        "A rectangle that is meshed here, its lower left corner at the origin.", {},
        [](S& s, const Given& given) {
          const toml::array& array = array_of(given, "pair of lengths", 2);
          for (std::size_t k = 0; k < 2; ++k) s.panel[k] = some_length().read(given.part(array[k]));
        });
    row("vertices", &S::vertices, whole(20, 1000000),
        "About how many vertices the panel's or garment's mesh has (default: as its fabrics ask for; a panel "
        "without one 1000).");
    row("seed", &S::seed, whole(0, most_seed),
        "Another seed, another mesh of the panel or garment (default: the garment file's own, of a panel "
        "1).");
    row("plane", &S::upright, enumeration<bool>({{"xy", true}, {"xz", false}}),
        "Where the panel starts: upright (xy, the default) or lying (xz).");
    row("start", &S::start, existing_file("an existing OBJ"),
        "Positions to start from, vertex by vertex; default: the rest shape.");
    row("model", &S::stvk, enumeration<bool>({{"tension-field", false}, {"stvk", true}}),
        "tension-field (default): compression costs nothing. stvk: a shell that buckles by itself.");
    row("residual", &S::residual, number({0, 1}),
        "Share of its stiffness that slack cloth keeps (default 0).");
    row("frames", &S::frames, whole(1, 100000),
        "How many frames the scene has (default 1): frame n of N stands at load (n − 1)/(N − 1).");
    row("tolerance", &S::tolerance, number({1e-14, 1}),
        "Converged where unbalanced forces are this share of those that meet (default 1e-8).");
    row("iterations", &S::iterations, whole(1, 1000000),
        "At most so many Newton steps a frame (default 1000).");
  });
  return keys;
}

const Keys<DrapeSettings>& material_keys() {
  using S = DrapeSettings;
  static const auto keys = keys_of<S>("material", [](auto& row) {
    row("fabric", &S::fabric, fabric(),
        "In place of young and thickness: the plate that is as stiff in bending and stretching, and the "
        "mesh's resolution. A garment's is its file's own unless it stands here.");
    row("young", &S::young, number({1e-6, 1e15}), "Young's modulus, Pa (default 1e6).");
    row("poisson", &S::poisson, number({0, 0.5}), "Poisson's ratio (default .3, or the fabric's).");
    row("thickness", &S::thickness, some_length(), "Thickness (default 1 mm).");
    row("density", "0 … 1e+06, or a weight such as \"120 g/m²\"",
        "kg/m³ (default 0), or weight an area (default: the fabric's).", {}, set_density);
  });
  return keys;
}

const Keys<shell::Loads>& load_keys() {
  using L = shell::Loads;
  static const auto keys = keys_of<L>("loads", [](auto& row) {
    row("gravity", vector("[x, y, z], m/s²"), "Default [0, -9.81, 0].", {},
        [](L& loads, const Vector& value) { loads.gravity = to_eigen(value); });
    row("pressure", &L::pressure, number({-1e9, 1e9}),
        "Pa, along the faces' normals. Parts that are open must be held all along their boundary.");
    row("gap", &L::gap, some_length(), "Obstacles begin to push this far off (default 2 mm).");
    row("friction", &L::friction, number({0, 1e3}), "Coefficient of friction on obstacles (default 0).");
  });
  return keys;
}

const Keys<Hold>& hold_keys() {
  static const auto keys = [] {
    auto all = keys_of<Hold>("hold", [](auto& row) {
      row("box", &Hold::box, box(), "Holds the vertices that start in this box.");
      row("vertices", &Hold::vertices, vertices(), "Holds these, in place of a box.");
      row("axes", "some of x, y, z, such as \"xz\"", "The coordinates that are held (default all: a clamp).",
          {}, [](Hold& hold, const Given& given) {
            const std::string word = text_of(given);
            if (word.empty() || word.find_first_not_of("xyz") != std::string::npos)
              throw Problem{"it names other axes"};
            for (std::size_t k = 0; k < 3; ++k) hold.axes[k] = word.find("xyz"[k]) != std::string::npos;
          });
      row("mirror", &Hold::mirror, truth(),
          "The shell is one side of a symmetric one: the plane across the one axis that is held is a mirror "
          "(default false).");
    });
    add_motion(all, "hold", "they are");
    return all;
  }();
  return keys;
}

const Keys<Force>& force_keys() {
  static const auto keys = keys_of<Force>("force", [](auto& row) {
    row("box", &Force::box, box(), "Pulls at the vertices that start in this box.");
    row("vertices", &Force::vertices, vertices(), "Pulls at these, in place of a box.");
    row("total", &Force::total, vector("[x, y, z], N"),
        "Shared out evenly among the vertices. Keeps its direction.");
    row("per_length", &Force::per_length, vector("[x, y, z], N/m"),
        "In place of `total`: a metre, at rest, of the boundary edges between the vertices.");
    row("grows", &Force::grows, truth(), "From nothing to its full size with the load (default false).");
  });
  return keys;
}

const Keys<Obstacle>& obstacle_keys() {
  using O = Obstacle;
  static const auto keys = [] {
    auto all = keys_of<O>("obstacle", [](auto& row) {
      const auto needed_by = [](const auto& is) { return KeyExtras{.needed = kind_names(is)}; };
      row("kind", &O::kind, enumeration(obstacle_words()), "What it is; must be there.",
          {.needed = always, .first = true});
      row("at", point(),
          fmt::format(
              "Centre, a point of the plane, or one end of the axis of a {}; must be there but for a mesh.",
              either(kind_names(has_axis))),
          needed_by(is_solid), [](O& o, const Vector& value) { o.shape.at = to_eigen(value); });
      row("to", point(),
          fmt::format("The other end of the axis of a {}; must be there for one.",
                      either(kind_names(has_axis))),
          needed_by(has_axis), [](O& o, const Vector& value) { o.shape.to = to_eigen(value); });
      row("normal", direction(), "Out of a plane's solid side (default [0, 1, 0]).", {},
          [](O& o, const Vector& value) { o.shape.normal = to_eigen(value); });
      row("radius", some_length(), fmt::format("Of {}.", plural(kind_names(has_radius))),
          needed_by(has_radius), [](O& o, double value) { o.shape.radius = value; });
      row("file", &O::file, existing_file("an existing model"),
          "Of a mesh: a closed surface, in metres; may be animated.", needed_by(is_mesh));
      row("clip", &O::clip, text().allowing("a name or an index, as text"),
          "The animation a mesh moves by, frame by frame of the scene (default: its first, if it has any).");
    });
    add_motion(all, "obstacle", "it is");
    return all;
  }();
  return keys;
}

std::vector<KeyText> all_keys() {
  std::vector<KeyText> all;
  append(all, drape_keys());
  append(all, material_keys());
  append(all, load_keys());
  append(all, hold_keys());
  append(all, force_keys());
  append(all, obstacle_keys());
  return all;
}

// A table [[name]] that acts on vertices: it names them in one of two ways.
void check_vertices(FileReader& reader, const toml::table& table, const std::string& name) {
  if (table.contains("box") == table.contains("vertices"))
    reader.complain(table.source().begin, fmt::format("[[{}]] needs either 'box' or 'vertices'", name));
}

Hold read_hold(FileReader& reader, const toml::table& table) {
  const toml::source_position at = table.source().begin;
  Hold hold;
  hold.place = reader.place(at);
  reader.read(hold_keys(), table, "[[hold]]", hold);
  check_vertices(reader, table, "hold");
  if (hold.mirror && std::count(hold.axes.begin(), hold.axes.end(), true) != 1)
    reader.complain(at, "key 'mirror': a mirror is the plane across one axis; name that one in 'axes'");
  if (hold.mirror && hold.motion.turn != 0) reader.complain(at, "key 'mirror': a mirror does not turn");
  return hold;
}

Force read_force(FileReader& reader, const toml::table& table) {
  Force force;
  force.place = reader.place(table.source().begin);
  reader.read(force_keys(), table, "[[force]]", force);
  check_vertices(reader, table, "force");
  if (table.contains("total") == table.contains("per_length"))
    reader.complain(table.source().begin, "[[force]] needs either 'total' or 'per_length'");
  return force;
}

Obstacle read_obstacle(FileReader& reader, const toml::table& table) {
  Obstacle obstacle;
  obstacle.place = reader.place(table.source().begin);
  if (!reader.read_first(obstacle_keys(), table, "[[obstacle]]", obstacle)) return obstacle;
  const std::string kind(obstacle.kind->words.name);
  reader.read(obstacle_keys(), table, fmt::format("an obstacle of kind {}", kind), obstacle, kind);
  if (has_axis(*obstacle.kind) && obstacle.shape.at == obstacle.shape.to)
    reader.complain(table.source().begin, "key 'to': the same place as 'at'; an axis must have a length");
  return obstacle;
}

// Keys that go without each other.
void check_together(const DrapeSettings& settings, FileReader& reader) {
  const toml::table& root = reader.root();
  if (settings.material.contains("fabric")) {
    for (const char* key : {"young", "thickness"})
      if (settings.material.contains(key))
        reader.complain(root["material"][key].node()->source().begin,
                        fmt::format("key '{}': follows from 'fabric'; take one of them out", key));
  }
  const auto needs = [&](const char* key, bool has_effect, const char* what) {
    if (const toml::node* node = root["drape"][key].node(); node && !has_effect)
      reader.complain(node->source().begin, fmt::format("key '{}': has no effect {}", key, what));
  };
  const bool garment = !settings.garment.empty(), mesh = !settings.mesh.empty(),
             panel = settings.panel[0] != 0;
  if (garment + mesh + panel != 1) {
    reader.complain({1, 1}, "[drape] needs one of 'mesh', 'garment' and 'panel'");
  } else {
    for (const char* key : {"pieces", "wrap"}) needs(key, garment, "without 'garment'");
    for (const char* key : {"vertices", "seed"}) needs(key, !mesh, "on a 'mesh', which is taken as it is");
    needs("plane", panel, "without 'panel'");
  }
  needs("residual", !settings.stvk, "on a stvk shell, which keeps all of its stiffness when it is slack");
}

}  // namespace

DrapeSettings parse_drape(std::string_view text, const fs::path& file) {
  FileReader reader(text, file);
  reader.all = all_keys();
  DrapeSettings settings;
  settings.file = file;
  using Table = const toml::table&;
  using At = const toml::source_position&;
  reader.read_tables({
      {"drape", false, [&](Table table, At) { reader.read(drape_keys(), table, "[drape]", settings); }},
      {"material", false,
       [&](Table table, At) {
         for (const auto& [key, place] : reader.read(material_keys(), table, "[material]", settings))
           settings.material.insert(key);
       }},
      {"loads", false, [&](Table table, At) { reader.read(load_keys(), table, "[loads]", settings.loads); }},
      {"hold", true, [&](Table table, At) { settings.holds.push_back(read_hold(reader, table)); }},
      {"force", true, [&](Table table, At) { settings.forces.push_back(read_force(reader, table)); }},
      {"obstacle", true,
       [&](Table table, At) { settings.obstacles.push_back(read_obstacle(reader, table)); }},
  });
  check_together(settings, reader);
  reader.finish();
  return settings;
}

DrapeSettings load_drape_settings(const fs::path& file) {
  return parse_drape(read_whole_text(file), file);
}

std::string drape_reference_markdown() {
  const Column table{"table", [](const KeyText& key) {
                       const bool repeated =
                           key.table == "hold" || key.table == "force" || key.table == "obstacle";
                       return (repeated ? "[[" : "[") + key.table + (repeated ? "]]" : "]");
                     }};
  return key_table(all_keys(), {table, name_column(), allowed_column(), doc_column()});
}

bool is_drape_file(const std::filesystem::path& file) {
  std::ifstream text(file);
  if (!text) return true;
  bool model = false;
  for (std::string line; std::getline(text, line);) {
    const auto begin = line.find_first_not_of(" \t");
    if (begin == std::string::npos) continue;
    if (line.compare(begin, 7, "[drape]") == 0) return true;
    model = model || line.compare(begin, 7, "[model]") == 0;
  }
  return !model;
}

}  // namespace plisse::config
