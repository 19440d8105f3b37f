// <plisse/wrinkle.h>: fields of base surfaces in memory.
#include "plisse/wrinkle.h"

#include <fmt/format.h>

#include "api/convert.h"
#include "base/eigen_glm.h"
#include "base/error.h"
#include "cloth/wrinkle.h"
#include "cloth/wrinkle_mesh.h"
#include "io/wrinkle_field.h"
#include "mesh/subdivide.h"

namespace plisse {
namespace {

cloth::WrinkleScene scene_of(const BaseSurface& base) {
  const std::string who = "base";
  api::check_surface(who, base.positions, base.triangles);
  api::check_count(who, "rest triangles", base.rest.size(), base.triangles.size());
  api::check_held(who, base.held, base.positions.size());
  cloth::WrinkleScene scene;
  scene.name = who;
  scene.material = api::to_shell(base.material);
  scene.surface.topology = shell::build_topology(base.triangles, base.positions.size());
  scene.surface.positions = points_to_eigen(api::points_to_glm(base.positions));
  for (std::size_t f = 0; f < base.rest.size(); ++f) {
    Eigen::Matrix<double, 2, 3> corners;
    for (std::size_t c = 0; c < 3; ++c)
      corners.col(static_cast<Eigen::Index>(c)) << base.rest[f][c][0], base.rest[f][c][1];
    scene.surface.rest.push_back(shell::rest_face(corners, f));
  }
  scene.held.assign(base.positions.size(), false);
  for (std::size_t v = 0; v < base.held.size(); ++v) scene.held[v] = base.held[v] != 0;
  return scene;
}

}  // namespace

WrinkleField load_field(const std::filesystem::path& file) {
  io::WrinkleField field = io::read_wrinkle_field(file, {});
  return {api::points_from(field.positions), std::move(field.triangles), std::move(field.amplitude),
          std::move(field.phase)};
}

void save_field(const std::filesystem::path& file, const WrinkleField& field) {
  io::write_wrinkle_field(file, api::to_io(field, file.string()));
}

WrinkleResult solve_wrinkles(const WrinkleRequest& request) {
  const log::Scope scope(api::sink_of(request.messages));
  if (request.levels && (*request.levels < 0 || *request.levels > most_levels))
    throw Error(ExitCode::bad_input,
                fmt::format("solve_wrinkles: {} levels; allowed: 0 … {}", *request.levels, most_levels));
  cloth::WrinkleRequest ours;
  ours.scene = scene_of(request.base);
  ours.pin_held = !request.free_held;
  ours.options.solve.max_iterations = request.max_iterations;
  ours.cache = request.cache;
  const cloth::WrinkleReport found = cloth::wrinkle_field(ours);
  const wrinkle::Field& field = found.field;
  const Eigen::VectorXd& amplitude = field.whole.waves.amplitude;

  WrinkleResult result;
  result.field = {
      request.base.positions, request.base.triangles, {amplitude.begin(), amplitude.end()}, field.phase};
  for (const shell::Edge& edge : ours.scene.surface.topology.edges) result.edges.push_back(edge.vertex);
  result.phase_difference.assign(field.one_form.begin(), field.one_form.end());
  const wrinkle::Solution& last = field.real.converged ? field.whole : field.real;
  result.energy = field.real.energy;
  result.waves = field.waves;
  result.iterations = field.iterations;
  result.converged = field.real.converged && field.whole.converged;
  result.reason = last.reason;
  if (request.mesh) {
    const cloth::WrinkleMesh mesh =
        cloth::wrinkle_mesh("wrinkles", ours.scene.surface, {amplitude, field.phase}, request.levels, true);
    result.mesh = api::mesh_of(mesh.file);
    result.levels = mesh.levels;
  }
  return result;
}

}  // namespace plisse
