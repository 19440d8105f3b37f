#include "cloth/drape_setup.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "base/atomic_file.h"
#include "base/eigen_glm.h"
#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "base/units.h"
#include "cloth/drape_garment.h"
#include "cloth/drape_mesh.h"
#include "cloth/drape_obstacles.h"
#include "cloth/fabric_material.h"
#include "config/drape_file.h"
#include "config/fabric.h"
#include "config/panel_file.h"
#include "io/obj.h"

namespace plisse::cloth {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using shell::Conditions;
using shell::Positions;

FlatMesh read_mesh(const fs::path& file) {
  const io::ObjFile obj = io::read_obj(file);
  if (obj.triangles.empty()) throw Error(ExitCode::bad_input, fmt::format("{}: has no faces", file.string()));
  return {points_to_eigen(obj.positions), obj.faces()};
}

// --- our own scenes
// -------------------------------------------------------------------------------------------

struct Held {
  config::DrapeSettings::Hold hold;
  std::vector<std::uint32_t> vertices;
};

// Those in a box, or those that are named. `one`: a [[hold]] or a [[force]].
std::vector<std::uint32_t> picked(const auto& one, const Positions& start) {
  std::vector<std::uint32_t> vertices = one.vertices;
  if (one.box) {
    for (Eigen::Index v = 0; v < start.cols(); ++v) {
      const glm::dvec3 p(start(0, v), start(1, v), start(2, v));
      if (glm::all(glm::lessThanEqual((*one.box)[0], p)) && glm::all(glm::lessThanEqual(p, (*one.box)[1])))
        vertices.push_back(static_cast<std::uint32_t>(v));
    }
    if (vertices.empty())
      throw Error(ExitCode::bad_input, fmt::format("{}: no vertex starts in this box", one.place));
  }
  for (const std::uint32_t v : vertices)
    if (v >= start.cols())
      throw Error(ExitCode::bad_input,
                  fmt::format("{}: there is no vertex {}; allowed: 0 to {}", one.place, v, start.cols() - 1));
  return vertices;
}

std::vector<Held> find_held(const config::DrapeSettings& settings, const Positions& start) {
  std::vector<Held> all;
  for (const auto& hold : settings.holds) {
    Held held{hold, picked(hold, start)};
    if (hold.mirror) {
      const auto axis =
          static_cast<int>(std::find(hold.axes.begin(), hold.axes.end(), true) - hold.axes.begin());
      const double at = start(axis, held.vertices.front());
      for (const std::uint32_t v : held.vertices)
        if (std::abs(start(axis, v) - at) >
            1e-6 * (start.rowwise().maxCoeff() - start.rowwise().minCoeff()).norm())
          throw Error(ExitCode::bad_input,
                      fmt::format("{}: vertices {} and {} lie in no one plane across {}, so it is no mirror",
                                  hold.place, held.vertices.front(), v, "xyz"[axis]));
    }
    all.push_back(std::move(held));
  }
  return all;
}

// Reports once the values that a fabric lacks and that were assumed.
shell::Material told_material(const std::string& who, const sizing::Fabric& fabric,
                              std::optional<double> poisson, std::optional<double> density,
                              std::optional<double> weight) {
  // A weight of 0 g/m² means that it follows from a density.
  FabricMaterial made = material_of(fabric, poisson, density ? std::optional(0.0) : weight);
  if (density) made.material.density = *density;
  if (!made.assumed.empty())
    log::notice(fmt::format("{}: {} tells no more, so there is taken: {}", who,
                            fabric.name.empty() ? "its fabric" : "fabric '" + fabric.name + "'",
                            fmt::join(made.assumed, "; ")));
  return made.material;
}

shell::Material material_of_scene(const config::DrapeSettings& settings, const sizing::Garment* garment) {
  const std::string who = settings.file.string();
  const auto told = [&](const char* key) { return settings.material.contains(key); };
  const std::optional<double> poisson = told("poisson") ? std::optional(settings.poisson) : std::nullopt;
  if (settings.fabric)
    return told_material(who, *settings.fabric, poisson, settings.density, settings.weight);
  if (garment && !told("young") && !told("thickness")) {
    const sizing::Fabric& fabric = garment->panels.front().fabric;
    for (const sizing::Panel& panel : garment->panels)
      if (panel.fabric.weft != fabric.weft || panel.fabric.warp != fabric.warp ||
          panel.fabric.density != fabric.density || panel.fabric.thickness != fabric.thickness ||
          panel.fabric.poisson_ratio != fabric.poisson_ratio)
        log::warn(fmt::format("{}: all of it is draped as the fabric of panel '{}'; '{}' has another",
                              settings.garment.string(), garment->panels.front().name, panel.name));
    return told_material(who, fabric, poisson, settings.density, settings.weight);
  }
  return {settings.young, settings.poisson, settings.thickness,
          settings.weight ? *settings.weight / settings.thickness : settings.density.value_or(0)};
}

void add_forces(const config::DrapeSettings& settings, DrapeScene& scene) {
  if (settings.forces.empty()) return;
  const auto topology = shell::build_topology(scene.faces, static_cast<std::size_t>(scene.start.cols()));
  const auto rest = shell::rest_faces(scene.rest, scene.rest_faces);
  shell::Loads always, growing;
  for (const auto& force : settings.forces) {
    shell::Loads& loads = force.grows ? growing : always;
    if (loads.forces.size() == 0) loads.forces = Positions::Zero(3, scene.start.cols());
    const auto vertices = picked(force, scene.start);
    if (force.total)
      for (const std::uint32_t v : vertices)
        loads.forces.col(v) += to_eigen(*force.total) / static_cast<double>(vertices.size());
    if (!force.per_length) continue;
    std::vector<bool> among(topology.vertex_count, false);
    for (const std::uint32_t v : vertices) among[v] = true;
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (const shell::Edge& edge : topology.edges)
      if (edge.boundary() && among[edge.vertex[0]] && among[edge.vertex[1]]) edges.push_back(edge.vertex);
    if (edges.empty())
      throw Error(
          ExitCode::bad_input,
          fmt::format("{}: no boundary edge has both of its ends here; 'per_length' needs one", force.place));
    shell::add_edge_forces(loads, topology, rest, edges, to_eigen(*force.per_length));
  }
  scene.loads.forces = always.forces;
  scene.growing_forces = growing.forces;
}

DrapeScene scene_of(const config::DrapeSettings& settings) {
  DrapeScene scene;
  scene.name = settings.file.stem().string();
  if (!settings.garment.empty()) {
    config::PanelFile panels =
        config::load_panels(settings.garment, settings.fabric ? &*settings.fabric : nullptr);
    try {
      config::keep_pieces(panels, settings.pieces);
    } catch (const Error& error) {
      throw Error(error.code, fmt::format("{}: [drape] pieces: {}", settings.file.string(), error.what()));
    }
    scene.material = material_of_scene(settings, &panels.garment);
    if (settings.seed) panels.options.seed = *settings.seed;
    const SewnGarment sewn = settings.vertices > 0
                                 ? sew_garment(panels.garment, settings.vertices, panels.options.seed)
                                 : sew_garment(panels.garment, panels.options);
    scene.rest = sewn.rest.points;
    scene.rest_faces = sewn.rest.faces;
    scene.faces = sewn.faces;
    scene.start = placed(sewn, panels.garment, settings.wrap);
  } else {
    scene.material = material_of_scene(settings, nullptr);
    const auto outline = rectangle_outline(settings.panel[0], settings.panel[1]);
    const int vertices = settings.vertices > 0 ? settings.vertices : 1000;
    const std::uint32_t seed = settings.seed.value_or(1);
    const FlatMesh mesh = !settings.mesh.empty() ? read_mesh(settings.mesh)
                          : settings.fabric && settings.vertices == 0
                              ? fabric_mesh(outline, *settings.fabric, seed)
                              : delaunay_mesh(outline, {}, vertices, seed);
    scene.rest = scene.start = mesh.points;
    scene.rest_faces = scene.faces = mesh.faces;
    if (settings.mesh.empty() && !settings.upright) {
      scene.start.row(2) = -mesh.points.row(1);
      scene.start.row(1).setZero();
    }
  }
  if (!settings.start.empty()) scene.start = read_start(settings.start, scene);
  if (settings.stvk) {
    scene.stretching = shell::Stretching::stvk;
    scene.bending = shell::Bending::midedge;
  }
  scene.residual = settings.residual;
  scene.loads = settings.loads;
  scene.newton.tolerance = settings.tolerance;
  scene.newton.max_iterations = settings.iterations;
  scene.frames = settings.frames;
  add_forces(settings, scene);
  if (scene.bending == shell::Bending::quadratic &&
      std::ranges::any_of(settings.holds, [](const auto& hold) { return hold.mirror; }))
    log::warn(fmt::format(
        "{}: mirrors count for bending with model = \"stvk\" alone; here their edges bend as free ones",
        settings.file.string()));
  place_obstacles(settings, scene);
  const Positions start = scene.start;
  scene.conditions = [start, all = find_held(settings, start)](double t) {
    Conditions conditions(static_cast<std::size_t>(start.cols()));
    // Mirrors last: vertices in their plane must be exactly in it, whatever else holds them.
    for (const bool mirrors : {false, true})
      for (const Held& held : all) {
        if (held.hold.mirror != mirrors) continue;
        const Eigen::Isometry3d motion = motion_at(held.hold.motion, t);
        for (const std::uint32_t v : held.vertices) {
          Vector3d at = motion * start.col(v);
          if (held.hold.mirror) at = motion * start.col(held.vertices.front());  // exactly one plane
          for (int axis = 0; axis < 3; ++axis) {
            if (!held.hold.axes[static_cast<std::size_t>(axis)]) continue;
            conditions.hold(v, axis, at[axis]);
            if (held.hold.mirror && v == held.vertices.front())
              conditions.mirrors.push_back({axis, at[axis]});
          }
        }
      }
    return conditions;
  };
  return scene;
}

// --- the authors' set-ups
// --------------------------------------------------------------------------------------

class Setup {
 public:
  explicit Setup(const fs::path& file) : file_(file) {
    const auto bytes = read_whole_file(file);
    json_ = nlohmann::json::parse(bytes.begin(), bytes.end(), nullptr, false);
    if (!json_.is_object())
      throw Error(ExitCode::bad_input, fmt::format("{}: is no JSON object", file.string()));
  }

  double number(const char* key, std::optional<double> otherwise = {}) {
    const auto found = json_.find(key);
    if (found == json_.end() && otherwise) return *otherwise;
    if (found != json_.end() && found->is_number() && std::isfinite(found->get<double>()))
      return found->get<double>();
    complain(
        fmt::format("key '{}': {}; a number is wanted", key, found == json_.end() ? "missing" : "no number"));
    return 0;
  }
  std::string text(const char* key) {
    const auto found = json_.find(key);
    return found != json_.end() && found->is_string() ? found->get<std::string>() : "";
  }
  bool flag(const char* key) {
    const auto found = json_.find(key);
    if (found == json_.end()) return false;
    if (!found->is_boolean()) complain(fmt::format("key '{}': true or false is wanted", key));
    return found->is_boolean() && found->get<bool>();
  }
  Vector3d vector(const char* key) {
    const auto found = json_.find(key);
    if (found == json_.end()) return Vector3d::Zero();
    Vector3d result = Vector3d::Zero();
    bool fine = found->is_array() && found->size() == 3;
    for (std::size_t k = 0; fine && k < 3; ++k) {
      fine = (*found)[k].is_number();
      if (fine) result[static_cast<int>(k)] = (*found)[k].get<double>();
    }
    if (!fine) complain(fmt::format("key '{}': three numbers are wanted", key));
    return result;
  }
  // The file that a key names; empty where there is none, with a warning if `wanted`.
  fs::path existing(const char* key, const char* what) {
    const std::string name = text(key);
    if (name.empty()) return {};
    const fs::path path = file_.parent_path() / name;
    std::error_code error;
    if (fs::is_regular_file(path, error)) return path;
    log::warn(fmt::format("{}: '{}' names {}, which is not there; solving without {}", file_.string(), key,
                          name, what));
    return {};
  }
  void complain(const std::string& problem) {
    if (!problems_.empty()) problems_ += '\n';
    problems_ += fmt::format("{}: {}", file_.string(), problem);
  }
  void throw_if_any() const {
    if (!problems_.empty()) throw Error(ExitCode::bad_input, problems_);
  }
  const fs::path& file() const { return file_; }

 private:
  fs::path file_;
  nlohmann::json json_;
  std::string problems_;
};

// "count", "#", then lines "vertex x y z" with # in place of a coordinate that is free.
Conditions read_clamps(const fs::path& file, std::size_t vertices) {
  Conditions conditions(vertices);
  std::size_t number = 0;
  int found = 0;
  std::optional<int> expected;
  const auto fail = [&](const std::string& what) {
    throw Error(ExitCode::bad_input, fmt::format("{}:{}: {}", file.string(), number, what));
  };
  for_each_line(read_whole_text(file), [&](std::string_view line, std::size_t line_number) {
    number = line_number;
    const auto word = words_of(line);
    if (word.empty() || (word.size() == 1 && word[0] == "#")) return;
    if (!expected && word.size() == 1) {
      const auto count = parse_number(word[0]);
      if (!count || *count < 0 || *count != std::floor(*count))
        fail("the number of clamped vertices is wanted");
      expected = static_cast<int>(*count);
      return;
    }
    if (word.size() != 4) fail("a vertex and three coordinates are wanted, # for one that is free");
    const auto vertex = parse_number(word[0]);
    if (!vertex || *vertex < 0 || *vertex >= static_cast<double>(vertices) || *vertex != std::floor(*vertex))
      fail(fmt::format("'{}' is no vertex; allowed: 0 to {}", word[0], vertices - 1));
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view text = word[static_cast<std::size_t>(axis) + 1];
      if (text == "#") continue;
      const auto at = parse_number(text);
      if (!at || !std::isfinite(*at)) fail(fmt::format("'{}' is no coordinate", text));
      conditions.hold(static_cast<std::uint32_t>(*vertex), axis, *at);
    }
    ++found;
  });
  if (expected && found != *expected)
    fail(fmt::format("{} vertices are promised, there are {}", *expected, found));
  return conditions;
}

// Positions of the base's vertices: the mean of those that a rest mesh, cut apart, has for each of them.
Positions drawn_together(const FlatMesh& rest, const FlatMesh& base) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;  // vertices of the base and of the rest mesh
  for (std::size_t f = 0; f < base.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) pairs.emplace(base.faces[f][k], rest.faces[f][k]);
  Positions sum = Positions::Zero(3, base.points.cols());
  Eigen::ArrayXd count = Eigen::ArrayXd::Zero(base.points.cols());
  for (const auto& [v, r] : pairs) {
    sum.col(v) += rest.points.col(r);
    count[v] += 1;
  }
  for (Eigen::Index v = 0; v < sum.cols(); ++v)
    if (count[v] > 0) sum.col(v) /= count[v];
  return sum;
}

DrapeScene scene_of(Setup& setup) {
  DrapeScene scene;
  scene.name = setup.file().stem().string();
  if (const std::string fabric = setup.text("fabric"); !fabric.empty()) {
    const double ratio = setup.number("poisson_ratio", -1), density = setup.number("density", -1);
    try {
      scene.material = told_material(setup.file().string(), config::parse_fabric(fabric),
                                     ratio < 0 ? std::nullopt : std::optional(ratio),
                                     density < 0 ? std::nullopt : std::optional(density), {});
    } catch (const Error& error) {
      setup.complain(fmt::format("key 'fabric': {}", error.what()));
    }
  } else {
    scene.material = {setup.number("youngs_modulus"), setup.number("poisson_ratio"),
                      setup.number("thickness"), setup.number("density", 0)};
  }
  scene.loads.gravity = setup.vector("gravity");
  scene.loads.pressure = setup.number("pressure", 0);
  const std::string stretching = setup.text("stretching_type");
  if (stretching == "StVK") {
    scene.stretching = shell::Stretching::stvk;
  } else if (!stretching.empty() && stretching != "tensionField") {
    setup.complain(fmt::format("key 'stretching_type': '{}'; allowed: tensionField or StVK", stretching));
  }
  const std::string bending = setup.text("bending_type");
  scene.bending = bending == "quadratic" || (bending.empty() && stretching != "StVK")
                      ? shell::Bending::quadratic
                      : shell::Bending::midedge;
  if (!bending.empty() && bending != "quadratic" && bending != "StVK")
    setup.complain(fmt::format("key 'bending_type': '{}'; allowed: quadratic or StVK", bending));
  scene.rest_flat = setup.flag("rest_flat");
  const std::string rest = setup.text("rest_mesh");
  if (rest.empty()) setup.complain("key 'rest_mesh': missing; an OBJ is wanted");
  setup.throw_if_any();

  const FlatMesh mesh = read_mesh(setup.file().parent_path() / rest);
  scene.rest = scene.start = mesh.points;
  scene.rest_faces = scene.faces = mesh.faces;
  // Sewn: the rest mesh is cut apart, and the faces of the authors' surface define which vertices are one.
  // Only its faces are used.
  const std::string current = setup.text("cur_mesh"), solved = setup.text("base_mesh");
  std::error_code error;
  if (!solved.empty()) {
    const FlatMesh base = read_mesh(setup.file().parent_path() / solved);
    if (base.faces.size() != mesh.faces.size())
      throw Error(
          ExitCode::bad_input,
          fmt::format("{}: 'base_mesh' has {} faces, 'rest_mesh' {}; face i of one is face i of the other",
                      setup.file().string(), base.faces.size(), mesh.faces.size()));
    scene.faces = base.faces;
    scene.start = base.points;
    scene.solved = true;
  } else if (!current.empty() && fs::is_regular_file(setup.file().parent_path() / current, error)) {
    const FlatMesh base = read_mesh(setup.file().parent_path() / current);
    if (base.faces != mesh.faces) {
      if (base.faces.size() != mesh.faces.size())
        throw Error(
            ExitCode::bad_input,
            fmt::format("{}: 'cur_mesh' has {} faces, 'rest_mesh' {}; face i of one is face i of the other",
                        setup.file().string(), base.faces.size(), mesh.faces.size()));
      scene.faces = base.faces;
      scene.start = drawn_together(mesh, base);
      log::warn(
          fmt::format("{}: the rest mesh is cut apart and sewn as '{}' says; the start is its pieces drawn "
                      "together at the seams, --start FILE gives a better one",
                      setup.file().string(), current));
    }
  }
  const auto obstacle = setup.existing("obs_mesh", "an obstacle");
  if (!obstacle.empty()) {
    const FlatMesh body = read_mesh(obstacle);
    scene.loads.obstacles = {
        std::make_shared<shell::TriangleBody>(body.points, body.faces, obstacle.string())};
    const double eta = setup.number("collision_eta", 0);
    if (eta > 0) scene.loads.gap = eta;
  }
  setup.existing("init_mesh", "a guess");
  const auto clamps = setup.existing("clamped_DOFs", "clamps");
  const auto count = static_cast<std::size_t>(scene.start.cols());
  const Conditions conditions = clamps.empty() ? Conditions(count) : read_clamps(clamps, count);
  scene.conditions = [conditions](double) { return conditions; };
  return scene;
}

}  // namespace

DrapeScene load_drape(const fs::path& file) {
  if (file.extension() == ".json") {
    Setup setup(file);
    DrapeScene scene = scene_of(setup);
    scene.chords = false;
    return scene;
  }
  if (file.extension() != ".toml")
    throw Error(ExitCode::bad_input, fmt::format("{}: neither a SCENE.toml nor a SETUP.json", file.string()));
  return scene_of(config::load_drape_settings(file));
}

Positions read_start(const fs::path& file, const DrapeScene& scene) {
  const Positions positions = read_mesh(file).points;
  if (positions.cols() != scene.start.cols())
    throw Error(ExitCode::bad_input, fmt::format("{}: has {} vertices, the base surface has {}",
                                                 file.string(), positions.cols(), scene.start.cols()));
  return positions;
}

}  // namespace plisse::cloth
