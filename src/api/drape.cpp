// <plisse/drape.h>: cloth in memory, files and examples become one kind of scene, which is solved.
#include "plisse/drape.h"

#include <fmt/format.h>

#include "api/convert.h"
#include "base/eigen_glm.h"
#include "base/error.h"
#include "cloth/drape.h"
#include "cloth/drape_examples.h"
#include "cloth/drape_setup.h"
#include "cloth/wrinkle.h"

namespace plisse {
namespace {

cloth::DrapeScene scene_of(const Cloth& cloth) {
  const std::string who = "cloth";
  api::check_surface(who, cloth.rest, cloth.triangles);
  if (!cloth.start.empty()) {
    api::check_count(who, "positions of start", cloth.start.size(), cloth.rest.size());
    api::check_surface(who, cloth.start, cloth.triangles);
  }
  api::check_held(who, cloth.held, cloth.rest.size());
  cloth::DrapeScene scene;
  scene.name = who;
  scene.rest = points_to_eigen(api::points_to_glm(cloth.rest));
  scene.rest_faces = scene.faces = cloth.triangles;
  scene.start = cloth.start.empty() ? scene.rest : points_to_eigen(api::points_to_glm(cloth.start));
  scene.material = api::to_shell(cloth.material);
  scene.loads.gravity = {cloth.gravity[0], cloth.gravity[1], cloth.gravity[2]};
  scene.loads.pressure = cloth.pressure;
  shell::Conditions conditions(cloth.rest.size());
  for (std::uint32_t v = 0; v < cloth.held.size(); ++v)
    if (cloth.held[v] != 0) conditions.hold(v, scene.start.col(v));
  scene.conditions = [conditions](double) { return conditions; };
  return scene;
}

cloth::DrapeScene scene_of(const DrapeRequest& request) {
  if (int(request.cloth.has_value()) + int(!request.file.empty()) + int(!request.example.empty()) != 1)
    throw Error(ExitCode::bad_input, "drape: give one of cloth, file and example");
  if (request.vertices != 0 && request.example.empty())
    throw Error(ExitCode::bad_input,
                "drape: vertices are for an example; cloth and files have their own mesh");
  cloth::DrapeScene scene = request.cloth          ? scene_of(*request.cloth)
                            : request.file.empty() ? cloth::drape_example(request.example, request.vertices)
                                                   : cloth::load_drape(request.file);
  if (request.steps < 0)
    throw Error(ExitCode::bad_input,
                fmt::format("drape: {} steps; there have to be 1 or more", request.steps));
  if (request.steps > 0) scene.frames = request.steps;
  return scene;
}

DrapeFrame frame_of(const cloth::DrapeFrame& frame) {
  const shell::Equilibrium& found = frame.equilibrium;
  return {frame.frame,     frame.load,   found.energy,  found.iterations,
          found.converged, found.reason, frame.measures};
}

// `held`: one a vertex.
BaseSurface base_of(const shell::Positions& positions, const std::vector<shell::Face>& faces,
                    const std::vector<shell::RestFace>& rest, const std::vector<bool>& held,
                    const shell::Material& material) {
  BaseSurface base;
  base.positions = api::points_from(points_to_glm(positions));
  base.triangles = faces;
  for (const shell::RestFace& face : rest) {
    const Eigen::Matrix2d& edges = face.edges;
    base.rest.push_back({{{0, 0}, {edges(0, 0), edges(1, 0)}, {edges(0, 1), edges(1, 1)}}});
  }
  base.held.assign(held.begin(), held.end());
  base.material = {material.young, material.poisson, material.thickness, material.density};
  return base;
}

}  // namespace

BaseSurface load_base(const std::filesystem::path& file, const MessageSink& messages) {
  const log::Scope scope(api::sink_of(messages));
  const cloth::WrinkleScene scene = cloth::read_base(file);
  return base_of(scene.surface.positions, scene.surface.topology.faces, scene.surface.rest, scene.held,
                 scene.material);
}

DrapeReport drape(const DrapeRequest& request) {
  const log::Scope scope(api::sink_of(request.messages));
  cloth::DrapeRequest ours;
  ours.scene = scene_of(request);
  ours.frames = request.frames;
  if (!request.output.empty()) ours.output = request.output;
  ours.cache = request.cache;
  const std::vector<shell::RestFace> rest = shell::rest_faces(ours.scene.rest, ours.scene.rest_faces);
  if (request.on_frame) {
    ours.on_frame = [&](const cloth::DrapeFrame& frame, const shell::Positions& positions) {
      const shell::Conditions conditions = ours.scene.conditions(frame.load);
      std::vector<bool> held;
      for (Eigen::Index v = 0; v < positions.cols(); ++v) held.push_back(conditions.held.col(v).all());
      request.on_frame(frame_of(frame),
                       base_of(positions, ours.scene.faces, rest, held, ours.scene.material));
    };
  }
  const cloth::DrapeReport found = cloth::drape(ours);
  DrapeReport report;
  for (const cloth::DrapeFrame& frame : found.frames) report.frames.push_back(frame_of(frame));
  report.converged = found.converged;
  report.failure = found.failure;
  return report;
}

}  // namespace plisse
