#include "pipeline/drape.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <random>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "config/frames.h"
#include "io/ply.h"
#include "io/point_cache.h"
#include "shell/carry.h"

namespace plisse {
namespace {

using shell::Positions;
using Clock = std::chrono::steady_clock;

double peak_rss_MiB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// A flat St. Venant-Kirchhoff sheet that is compressed is in equilibrium, but stays flat only if nothing
// disturbs it.
Positions perturbed(const DrapeScene& scene) {
  Positions positions = scene.start;
  if (scene.perturb == 0) return positions;
  const shell::Conditions conditions = scene.conditions(0);
  std::mt19937 random(1);
  for (Eigen::Index v = 0; v < positions.cols(); ++v)
    for (int axis = 0; axis < 3; ++axis) {
      const double share = static_cast<double>(random()) / 2147483647.5 - 1;  // −1 … 1, the same everywhere
      if (!conditions.held(axis, v)) positions(axis, v) += scene.perturb * share;
    }
  return positions;
}

std::filesystem::path frame_file(const std::filesystem::path& pattern, int frame) {
  std::string path = frame_path(pattern.string() + ".png", frame);  // patterns are those of pictures
  return path.substr(0, path.size() - 4);
}

}  // namespace

shell::Shell shell_of(const DrapeScene& scene) {
  if (scene.rest_faces.size() != scene.faces.size())
    throw Error(ExitCode::bad_input,
                fmt::format("{} rest triangles for {} faces: each face needs one, in the same order",
                            scene.rest_faces.size(), scene.faces.size()));
  shell::Shell shell;
  shell.topology = shell::build_topology(scene.faces, static_cast<std::size_t>(scene.start.cols()));
  shell::build_topology(scene.rest_faces, static_cast<std::size_t>(scene.rest.cols()));  // for its checks
  shell.rest = shell::rest_faces(scene.rest, scene.rest_faces);
  shell.material = scene.material;
  shell.stretching = scene.stretching;
  shell.bending = scene.bending;
  shell.residual = scene.residual;
  return shell;
}

void write_base(const std::filesystem::path& path, const DrapeScene& scene, const DrapeFrame& frame,
                const Positions& positions) {
  using io::PlyProperty;
  io::Ply ply;
  ply.comments = {fmt::format("plisse drape {} load {}", scene.name, frame.load),
                  fmt::format("young {}", scene.material.young),
                  fmt::format("poisson {}", scene.material.poisson),
                  fmt::format("thickness {}", scene.material.thickness),
                  fmt::format("density {}", scene.material.density)};
  if (!frame.equilibrium.converged) ply.comments.push_back("not converged: " + frame.equilibrium.reason);
  const auto count = static_cast<std::size_t>(positions.cols());
  io::PlyElement vertices{"vertex", count, {{"x"}, {"y"}, {"z"}, {"held", PlyProperty::Type::uint8}}};
  const shell::Conditions conditions = scene.conditions(frame.load);
  for (Eigen::Index v = 0; v < positions.cols(); ++v) {
    for (int axis = 0; axis < 3; ++axis)
      vertices.properties[static_cast<std::size_t>(axis)].values.push_back(positions(axis, v));
    vertices.properties[3].values.push_back(conditions.held.col(v).all() ? 1 : 0);
  }
  io::PlyElement faces{
      "face",
      scene.faces.size(),
      {{"vertex_indices", PlyProperty::Type::int32, true}, {"rest", PlyProperty::Type::float64, true}}};
  const auto rest = shell::rest_faces(scene.rest, scene.rest_faces);
  for (std::size_t f = 0; f < scene.faces.size(); ++f) {
    auto& corners = faces.properties[0];
    for (const std::uint32_t v : scene.faces[f]) corners.values.push_back(v);
    corners.ends.push_back(corners.values.size());
    auto& flat = faces.properties[1];
    const Eigen::Matrix2d& edges = rest[f].edges;
    flat.values.insert(flat.values.end(), {0, 0, edges(0, 0), edges(1, 0), edges(0, 1), edges(1, 1)});
    flat.ends.push_back(flat.values.size());
  }
  ply.elements = {std::move(vertices), std::move(faces)};
  io::write_ply(path, ply);
}

DrapeReport drape(const DrapeRequest& request) {
  const DrapeScene& scene = request.scene;
  const auto began = Clock::now();
  const bool pattern = is_frame_pattern(request.output.string());
  if (request.output.extension() != ".ply")
    throw Error(
        ExitCode::bad_input,
        fmt::format("{}: base surfaces are written as PLY; end the name with .ply", request.output.string()));
  const std::vector<int> picked =
      request.frames.empty() ? std::vector<int>{scene.frames} : select_frames(request.frames, scene.frames);
  const bool from_start = picked.size() > 1 || picked.front() < scene.frames;
  check_writable(pattern ? frame_file(request.output, picked.front()) : request.output);

  const shell::Shell shell = shell_of(scene);
  DrapeReport report;
  report.vertices = shell.topology.vertex_count;
  report.faces = shell.topology.faces.size();
  Positions positions = perturbed(scene);
  std::vector<Positions> cache;
  for (int n = from_start ? 1 : scene.frames; n <= picked.back() && !report.interrupted; ++n) {
    DrapeFrame frame;
    frame.frame = n;
    frame.load = scene.frames > 1 ? static_cast<double>(n - 1) / (scene.frames - 1) : 1;
    const shell::Conditions conditions = scene.conditions(frame.load);
    // Carrying knows nothing of obstacles and could take cloth through them: beside them only what is held
    // moves.
    const Positions start =
        scene.loads.obstacles.empty() ? shell::carried(shell, conditions, positions) : positions;
    frame.equilibrium = shell::find_equilibrium(shell, conditions, scene.loads, start, scene.newton,
                                                [&](const shell::NewtonStep& step, const Positions&) {
                                                  if (request.progress)
                                                    request.progress(n, scene.frames, step);
                                                  return !interrupted();
                                                });
    positions = frame.equilibrium.positions;
    report.interrupted = interrupted() && !frame.equilibrium.converged;
    const bool wanted = std::find(picked.begin(), picked.end(), n) != picked.end();
    if (!wanted && !report.interrupted) {
      if (!frame.equilibrium.converged)
        log::warn(fmt::format("frame {} on the way did not converge: {}", n, frame.equilibrium.reason));
      continue;
    }
    report.converged &= frame.equilibrium.converged;
    if (scene.measures) frame.measures = scene.measures(positions);
    if (pattern || cache.empty()) {
      const auto path = pattern ? frame_file(request.output, n) : request.output;
      write_base(path, scene, frame, positions);
      frame.path = path.string();
      report.outputs.push_back(path);
    }
    cache.push_back(positions);
    report.frames.push_back(std::move(frame));
  }
  if (!pattern && cache.size() > 1) {
    const auto path = std::filesystem::path(request.output).replace_extension(".pc2");
    std::vector<double> times;
    for (std::size_t f = 0; f < cache.size(); ++f) times.push_back(static_cast<double>(f) / 24);
    io::PointCacheWriter writer(path, report.vertices, times);
    for (const Positions& frame : cache) {
      std::vector<glm::dvec3> points;
      for (Eigen::Index v = 0; v < frame.cols(); ++v)
        points.emplace_back(frame(0, v), frame(1, v), frame(2, v));
      writer.add(points);
    }
    writer.commit();
    report.outputs.push_back(path);
  }
  report.wall_s = std::chrono::duration<double>(Clock::now() - began).count();
  report.peak_rss_MiB = peak_rss_MiB();
  return report;
}

}  // namespace plisse
