#include "config/drape_file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <functional>
#include <set>

#include "base/atomic_file.h"
#include "base/eigen_glm.h"
#include "config/complaints.h"
#include "config/fabric_key.h"
#include "config/kinds.h"
#include "config/suggest.h"

namespace plisse::config {
namespace {

namespace fs = std::filesystem;
using config::Complaints;
using config::Problem;
using Node = toml::node;
using Motion = DrapeSettings::Motion;
using Obstacle = DrapeSettings::Obstacle;

// A key sets the settings; those of [[hold]] and [[obstacle]] the last one that was begun.
struct Key {
  std::string table, name, allowed, doc;
  std::function<void(DrapeSettings&, const Node&, const fs::path& folder)> set;
  // In place of `set`, for values of several parts: complains by itself.
  std::function<void(DrapeSettings&, const Node&, Complaints&)> read = {};
};

constexpr config::Range lengths{1e-9, 1e6};

glm::dvec3 vector_of(const Node& node, const std::function<double(const Node&)>& number) {
  const toml::array* array = node.as_array();
  if (!array || array->size() != 3) throw Problem{"it is no array of three numbers", ""};
  glm::dvec3 result{0};
  for (int k = 0; k < 3; ++k)
    result[k] = config::within(number((*array)[static_cast<std::size_t>(k)]), {-1e9, 1e9});
  return result;
}
glm::dvec3 point_of(const Node& node) {
  return vector_of(node, config::length_of);
}
glm::dvec3 direction_of(const Node& node) {
  const glm::dvec3 direction = vector_of(node, config::number_of);
  if (glm::length(direction) == 0) throw Problem{"it has no direction", ""};
  return glm::normalize(direction);
}

bool truth_of(const Node& node) {
  if (!node.is_boolean()) throw Problem{"it is neither true nor false", ""};
  return node.as_boolean()->get();
}
std::array<glm::dvec3, 2> box_of(const Node& node) {
  const toml::array* array = node.as_array();
  if (!array || array->size() != 2) throw Problem{"it is no pair of corners", ""};
  const glm::dvec3 a = point_of((*array)[0]), b = point_of((*array)[1]);
  return {glm::min(a, b), glm::max(a, b)};
}
std::vector<std::uint32_t> vertices_of(const Node& node) {
  const toml::array* array = node.as_array();
  if (!array || array->empty()) throw Problem{"it is no array of numbers", ""};
  std::vector<std::uint32_t> vertices;
  for (const Node& item : *array)
    vertices.push_back(static_cast<std::uint32_t>(
        config::within(static_cast<double>(config::whole_of(item)), {0, 4294967294.0})));
  return vertices;
}

std::function<void(DrapeSettings&, const Node&, const fs::path&)> number(double DrapeSettings::*member,
                                                                         config::Range range) {
  return [=](DrapeSettings& s, const Node& n, const fs::path&) {
    s.*member = config::within(config::number_of(n), range);
  };
}

std::function<void(DrapeSettings&, const Node&, const fs::path&)> number(double shell::Loads::*member,
                                                                         config::Range range) {
  return [=](DrapeSettings& s, const Node& n, const fs::path&) {
    s.loads.*member = config::within(config::number_of(n), range);
  };
}

// The kinds of obstacles for which `is` holds, by name.
std::vector<std::string> kind_names(const std::function<bool(const shell::ObstacleKind&)>& is) {
  std::vector<std::string> names;
  for (const shell::ObstacleKind& kind : shell::obstacle_kinds())
    if (is(kind)) names.emplace_back(kind.words.name);
  return names;
}
bool any_kind(const shell::ObstacleKind&) {
  return true;
}
bool has_axis(const shell::ObstacleKind& kind) {
  return kind.words.axis;
}
bool has_radius(const shell::ObstacleKind& kind) {
  return kind.words.radius;
}
// "spheres, capsules and cylinders"
std::string plural(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i] + "s";
  return text;
}

void add_motion(std::vector<Key>& keys, const std::string& table, const std::string& who,
                const std::function<Motion&(DrapeSettings&)>& motion) {
  keys.push_back({table, "move", "[x, y, z], lengths", fmt::format("How far {} taken at full load.", who),
                  [=](DrapeSettings& s, const Node& n, const fs::path&) { motion(s).move = point_of(n); }});
  keys.push_back({table, "turn", "-36000 … 36000",
                  fmt::format("By how many degrees {} turned at full load, before {} moved.", who, who),
                  [=](DrapeSettings& s, const Node& n, const fs::path&) {
                    motion(s).turn = config::within(config::number_of(n), {-36000, 36000});
                  }});
  keys.push_back(
      {table, "axis", "[x, y, z]", "The axis of the turn (default [0, 1, 0]).",
       [=](DrapeSettings& s, const Node& n, const fs::path&) { motion(s).axis = direction_of(n); }});
  keys.push_back({table, "point", "[x, y, z], lengths", "A point on it (default the origin).",
                  [=](DrapeSettings& s, const Node& n, const fs::path&) { motion(s).point = point_of(n); }});
}

std::vector<Key> all_keys() {
  std::vector<Key> all = {
      {"drape", "mesh", "an existing OBJ", "The rest shape, flat or not. Either this, `garment` or `panel`.",
       [](DrapeSettings& s, const Node& n, const fs::path& folder) {
         s.mesh = config::existing_file(n, folder);
       }},
      {"drape", "garment", "an existing panel file",
       "Panels with seams (docs/sizing.md): sewn, placed as they say there, their x from right to left of "
       "who wears "
       "them.",
       [](DrapeSettings& s, const Node& n, const fs::path& folder) {
         s.garment = config::existing_file(n, folder);
       }},
      {"drape", "wrap", "a length",
       "Bends each of a garment's panels round an upright cylinder of this radius before it is placed, x = 0 "
       "in "
       "front.",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         s.wrap = config::within(config::length_of(n), lengths);
       }},
      {"drape", "pieces", "a text or an array of texts",
       "Of a garment: these panels alone, by name, and the seams between them (default: all).",
       [](DrapeSettings& s, const Node& n, const fs::path&) { s.pieces = config::names_of(n); }},
      {"drape", "panel", "[width, height], lengths",
       "A rectangle that is meshed here, its lower left corner at the origin.",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         const toml::array* array = n.as_array();
         if (!array || array->size() != 2) throw Problem{"it is no array of two lengths", ""};
         for (std::size_t k = 0; k < 2; ++k)
           s.panel[k] = config::within(config::length_of((*array)[k]), lengths);
       }},
      {"drape", "vertices", "20 … 1000000",
       "About how many vertices the panel's or garment's mesh has (default: as its fabrics ask for; a panel "
       "without one 1000).",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         s.vertices = static_cast<int>(config::within(static_cast<double>(config::whole_of(n)), {20, 1e6}));
       }},
      {"drape", "seed", "0 … 4294967295",
       "Another seed, another mesh of the panel or garment (default: the garment file's own, of a panel 1).",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         s.seed = static_cast<std::uint32_t>(
             config::within(static_cast<double>(config::whole_of(n)), {0, 4294967295.0}));
       }},
      {"drape", "plane", "xy or xz", "Where the panel starts: upright (xy, the default) or lying (xz).",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         const std::string word = config::text_of(n);
         if (word != "xy" && word != "xz") throw config::unknown_word(word, {"xy", "xz"});
         s.upright = word == "xy";
       }},
      {"drape", "start", "an existing OBJ",
       "Positions to start from, vertex by vertex; default: the rest shape.",
       [](DrapeSettings& s, const Node& n, const fs::path& folder) {
         s.start = config::existing_file(n, folder);
       }},
      {"drape", "model", "tension-field or stvk",
       "tension-field (default): compression costs nothing. stvk: a shell that buckles by itself.",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         const std::string word = config::text_of(n);
         if (word != "tension-field" && word != "stvk")
           throw config::unknown_word(word, {"tension-field", "stvk"});
         s.stvk = word == "stvk";
       }},
      {"drape", "residual", "0 … 1", "Share of its stiffness that slack cloth keeps (default 0).",
       number(&DrapeSettings::residual, {0, 1})},
      {"drape", "frames", "1 … 100000",
       "How many frames the scene has (default 1): frame n of N stands at load (n − 1)/(N − 1).",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         s.frames = static_cast<int>(config::within(static_cast<double>(config::whole_of(n)), {1, 1e5}));
       }},
      {"drape", "tolerance", "1e-14 … 1",
       "Converged where unbalanced forces are this share of those that meet (default 1e-8).",
       number(&DrapeSettings::tolerance, {1e-14, 1})},
      {"drape", "iterations", "1 … 1000000", "At most so many Newton steps a frame (default 1000).",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         s.iterations = static_cast<int>(config::within(static_cast<double>(config::whole_of(n)), {1, 1e6}));
       }},
      {"material",
       "fabric",
       config::fabric_allowed,
       "In place of young and thickness: the plate that is as stiff in bending and stretching, and the "
       "mesh's "
       "resolution. A garment's is its file's own unless it stands here.",
       {},
       [](DrapeSettings& s, const Node& n, Complaints& complaints) {
         s.fabric = config::read_fabric(n, 1, complaints);
       }},
      {"material", "young", "1e-06 … 1e+15", "Young's modulus, Pa (default 1e6).",
       number(&DrapeSettings::young, {1e-6, 1e15})},
      {"material", "poisson", "0 … 0.5", "Poisson's ratio (default .3, or the fabric's).",
       number(&DrapeSettings::poisson, {0, 0.5})},
      {"material", "thickness", "a length", "Thickness (default 1 mm).",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         s.thickness = config::within(config::length_of(n), lengths);
       }},
      {"material", "density", "0 … 1e+06, or a weight such as \"120 g/m²\"",
       "kg/m³ (default 0), or weight an area (default: the fabric's).",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         if (!n.is_string()) {
           s.density = config::within(config::number_of(n), {0, 1e6});
           return;
         }
         const auto weight = sizing::parse_density(config::text_of(n));
         if (config::text_of(n).find_first_not_of("0123456789.eE+- ") == std::string::npos)
           throw Problem{fmt::format("'{}' has no unit; as a number it is kg/m³", config::text_of(n)), ""};
         if (!weight) throw Problem{fmt::format("'{}' is no weight", config::text_of(n)), ""};
         s.weight = config::within(*weight, {0, 1e3});
       }},
      {"loads", "gravity", "[x, y, z], m/s²", "Default [0, -9.81, 0].",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         s.loads.gravity = to_eigen(vector_of(n, config::number_of));
       }},
      {"loads", "pressure", "-1e+09 … 1e+09",
       "Pa, along the faces' normals. Parts that are open must be held all along their boundary.",
       number(&shell::Loads::pressure, {-1e9, 1e9})},
      {"loads", "gap", "a length", "Obstacles begin to push this far off (default 2 mm).",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         s.loads.gap = config::within(config::length_of(n), lengths);
       }},
      {"loads", "friction", "0 … 1000", "Coefficient of friction on obstacles (default 0).",
       number(&shell::Loads::friction, {0, 1e3})},
      {"hold", "box", "[[x, y, z], [x, y, z]]", "Holds the vertices that start in this box.",
       [](DrapeSettings& s, const Node& n, const fs::path&) { s.holds.back().box = box_of(n); }},
      {"hold", "vertices", "an array of vertex numbers, from 0", "Holds these, in place of a box.",
       [](DrapeSettings& s, const Node& n, const fs::path&) { s.holds.back().vertices = vertices_of(n); }},
      {"hold", "axes", "some of x, y, z, such as \"xz\"",
       "The coordinates that are held (default all: a clamp).",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         const std::string word = config::text_of(n);
         if (word.empty() || word.find_first_not_of("xyz") != std::string::npos)
           throw Problem{"it names other axes", ""};
         for (std::size_t k = 0; k < 3; ++k)
           s.holds.back().axes[k] = word.find("xyz"[k]) != std::string::npos;
       }},
  };
  all.push_back(
      {"hold", "mirror", "true or false",
       "The shell is one side of a symmetric one: the plane across the one axis that is held is a mirror "
       "(default false).",
       [](DrapeSettings& s, const Node& n, const fs::path&) { s.holds.back().mirror = truth_of(n); }});
  add_motion(all, "hold", "they are", [](DrapeSettings& s) -> Motion& { return s.holds.back().motion; });
  const std::vector<Key> force = {
      {"force", "box", "[[x, y, z], [x, y, z]]", "Pulls at the vertices that start in this box.",
       [](DrapeSettings& s, const Node& n, const fs::path&) { s.forces.back().box = box_of(n); }},
      {"force", "vertices", "an array of vertex numbers, from 0", "Pulls at these, in place of a box.",
       [](DrapeSettings& s, const Node& n, const fs::path&) { s.forces.back().vertices = vertices_of(n); }},
      {"force", "total", "[x, y, z], N", "Shared out evenly among the vertices. Keeps its direction.",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         s.forces.back().total = vector_of(n, config::number_of);
       }},
      {"force", "per_length", "[x, y, z], N/m",
       "In place of `total`: a metre, at rest, of the boundary edges between the vertices.",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         s.forces.back().per_length = vector_of(n, config::number_of);
       }},
      {"force", "grows", "true or false", "From nothing to its full size with the load (default false).",
       [](DrapeSettings& s, const Node& n, const fs::path&) { s.forces.back().grows = truth_of(n); }},
  };
  all.insert(all.end(), force.begin(), force.end());
  const std::vector<Key> obstacle = {
      {"obstacle", "kind", config::either(kind_names(any_kind)), "What it is; must be there.",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         const std::string word = config::text_of(n);
         const auto& kinds = shell::obstacle_kinds();
         const auto found = std::find_if(kinds.begin(), kinds.end(),
                                         [&](const auto& kind) { return kind.words.name == word; });
         if (found == kinds.end()) throw config::unknown_word(word, kind_names(any_kind));
         s.obstacles.back().kind = &*found;
       }},
      {"obstacle", "at", "[x, y, z], lengths",
       fmt::format("Centre, a point of the plane, or one end of the axis of a {}; must be there but for a "
                   "mesh.",
                   config::either(kind_names(has_axis))),
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         s.obstacles.back().shape.at = to_eigen(point_of(n));
       }},
      {"obstacle", "to", "[x, y, z], lengths",
       fmt::format("The other end of the axis of a {}; must be there for one.",
                   config::either(kind_names(has_axis))),
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         s.obstacles.back().shape.to = to_eigen(point_of(n));
       }},
      {"obstacle", "normal", "[x, y, z]", "Out of a plane's solid side (default [0, 1, 0]).",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         s.obstacles.back().shape.normal = to_eigen(direction_of(n));
       }},
      {"obstacle", "radius", "a length", fmt::format("Of {}.", plural(kind_names(has_radius))),
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         s.obstacles.back().shape.radius = config::within(config::length_of(n), lengths);
       }},
      {"obstacle", "file", "an existing model", "Of a mesh: a closed surface, in metres; may be animated.",
       [](DrapeSettings& s, const Node& n, const fs::path& folder) {
         s.obstacles.back().file = config::existing_file(n, folder);
       }},
      {"obstacle", "clip", "a name or an index, as text",
       "The animation a mesh moves by, frame by frame of the scene (default: its first, if it has any).",
       [](DrapeSettings& s, const Node& n, const fs::path&) {
         s.obstacles.back().clip = config::text_of(n);
       }},
  };
  all.insert(all.end(), obstacle.begin(), obstacle.end());
  add_motion(all, "obstacle", "it is", [](DrapeSettings& s) -> Motion& { return s.obstacles.back().motion; });
  return all;
}

const std::vector<Key>& keys() {
  static const std::vector<Key> all = all_keys();
  return all;
}

bool repeated(const std::string& table) {
  return table == "hold" || table == "force" || table == "obstacle";
}

void read_table(const std::string& name, const toml::table& table, DrapeSettings& settings,
                Complaints& complaints) {
  std::vector<std::string> names;
  for (const Key& key : keys())
    if (key.table == name) names.push_back(key.name);
  for (const auto& [toml_key, node] : table) {
    const auto found =
        std::find_if(keys().begin(), keys().end(), [&, given = std::string(toml_key.str())](const Key& key) {
          return key.table == name && key.name == given;
        });
    if (found == keys().end()) {
      complaints.add(toml_key.source().begin,
                     fmt::format("key '{}': unknown in {}; allowed: {}{}", toml_key.str(), name,
                                 config::either(names), did_you_mean(toml_key.str(), names)));
      continue;
    }
    if (name == "material") settings.material.insert(found->name);
    try {
      if (found->read)
        found->read(settings, node, complaints);
      else
        found->set(settings, node, settings.file.parent_path());
    } catch (const Problem& problem) {
      complaints.add(toml_key.source().begin, fmt::format("key '{}': {}; allowed: {}{}", toml_key.str(),
                                                          problem.what, found->allowed, problem.hint));
    }
  }
}

void check_item(const std::string& name, const toml::table& table, const DrapeSettings& settings,
                Complaints& complaints) {
  const toml::source_position at = table.source().begin;
  if (name != "obstacle" && table.contains("box") == table.contains("vertices"))
    complaints.add(at, fmt::format("[[{}]] needs either 'box' or 'vertices'", name));
  if (name == "force" && table.contains("total") == table.contains("per_length"))
    complaints.add(at, "[[force]] needs either 'total' or 'per_length'");
  if (name == "hold" && settings.holds.back().mirror) {
    const auto& hold = settings.holds.back();
    if (std::count(hold.axes.begin(), hold.axes.end(), true) != 1)
      complaints.add(at, "key 'mirror': a mirror is the plane across one axis; name that one in 'axes'");
    if (hold.motion.turn != 0) complaints.add(at, "key 'mirror': a mirror does not turn");
  }
  if (name != "obstacle") return;
  if (!table.contains("kind"))
    complaints.add(at, fmt::format("key 'kind': missing; allowed: {}", config::either(kind_names(any_kind))));
  const Obstacle& obstacle = settings.obstacles.back();
  if (!obstacle.kind) return;  // which is complained of
  if (!obstacle.kind->make) {
    if (!table.contains("file")) complaints.add(at, "key 'file': missing; meshes need the model they are");
    return;
  }
  if (!table.contains("at")) complaints.add(at, "key 'at': missing; where the obstacle is");
  const bool axis = has_axis(*obstacle.kind);
  if (axis && !table.contains("to"))
    complaints.add(at, fmt::format("key 'to': missing; {} need the other end of their axis",
                                   plural(kind_names(has_axis))));
  if (axis && obstacle.shape.at == obstacle.shape.to)
    complaints.add(at, "key 'to': the same place as 'at'; an axis must have a length");
  if (has_radius(*obstacle.kind) && !table.contains("radius"))
    complaints.add(at, fmt::format("key 'radius': missing; {} need it", plural(kind_names(has_radius))));
}

}  // namespace

DrapeSettings parse_drape(std::string_view text, const fs::path& file) {
  const toml::table root = config::parse_toml(text, file);
  Complaints complaints(file);
  DrapeSettings settings;
  settings.file = file;
  const std::vector<std::string> tables = {"drape", "material", "loads", "hold", "force", "obstacle"};
  for (const auto& [toml_key, node] : root) {
    const std::string name(toml_key.str());
    if (std::find(tables.begin(), tables.end(), name) == tables.end()) {
      complaints.add(toml_key.source().begin,
                     fmt::format("'{}': unknown; allowed: {}{}", name, config::either(tables),
                                 did_you_mean(name, tables)));
    } else if (!repeated(name) && node.is_table()) {
      read_table(name, *node.as_table(), settings, complaints);
    } else if (repeated(name) && node.is_array_of_tables()) {
      for (const Node& item : *node.as_array()) {
        const std::string place = config::place_in(file, item.source().begin);
        if (name == "hold") settings.holds.emplace_back().place = place;
        if (name == "force") settings.forces.emplace_back().place = place;
        if (name == "obstacle") settings.obstacles.emplace_back().place = place;
        read_table(name, *item.as_table(), settings, complaints);
        check_item(name, *item.as_table(), settings, complaints);
      }
    } else {
      complaints.add(toml_key.source().begin,
                     fmt::format("'{}': write {} and its keys below", name,
                                 repeated(name) ? "[[" + name + "]]" : "[" + name + "]"));
    }
  }
  if (settings.material.contains("fabric")) {
    for (const char* key : {"young", "thickness"})
      if (settings.material.contains(key))
        complaints.add(root["material"][key].node()->source().begin,
                       fmt::format("key '{}': follows from 'fabric'; take one of them out", key));
  }
  const auto needs = [&](const char* key, bool has_effect, const char* what) {
    if (const Node* node = root["drape"][key].node(); node && !has_effect)
      complaints.add(node->source().begin, fmt::format("key '{}': has no effect {}", key, what));
  };
  const bool garment = !settings.garment.empty(), mesh = !settings.mesh.empty(),
             panel = settings.panel[0] != 0;
  if (garment + mesh + panel != 1) {
    complaints.add({1, 1}, "[drape] needs one of 'mesh', 'garment' and 'panel'");
  } else {
    for (const char* key : {"pieces", "wrap"}) needs(key, garment, "without 'garment'");
    for (const char* key : {"vertices", "seed"}) needs(key, !mesh, "on a 'mesh', which is taken as it is");
    needs("plane", panel, "without 'panel'");
  }
  needs("residual", !settings.stvk, "on a stvk shell, which keeps all of its stiffness when it is slack");
  complaints.throw_if_any();
  return settings;
}

DrapeSettings load_drape_settings(const fs::path& file) {
  return parse_drape(read_whole_text(file), file);
}

std::string drape_reference_markdown() {
  std::string text = "| table | key | allowed | what it does |\n|---|---|---|---|\n";
  for (const Key& key : keys())
    text += fmt::format("| {} | `{}` | {} | {} |\n",
                        repeated(key.table) ? "[[" + key.table + "]]" : "[" + key.table + "]", key.name,
                        key.allowed, key.doc);
  return text;
}

}  // namespace plisse::config
