#include "cloth/drape.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "base/eigen_glm.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "cloth/base_file.h"
#include "cloth/cached_solves.h"
#include "config/frames.h"
#include "io/ply.h"
#include "io/point_cache.h"
#include "shell/carry.h"
#include "shell/fundamental_forms.h"

namespace plisse::cloth {
namespace {

using shell::Positions;

double peak_rss_MiB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// A point cache beside `output`: times are those of the frames in the scene, 24 a second.
std::filesystem::path write_cache(const std::filesystem::path& output, const std::vector<int>& frames,
                                  const std::vector<Positions>& positions) {
  const auto path = std::filesystem::path(output).replace_extension(".pc2");
  std::vector<double> times;
  for (const int frame : frames) times.push_back((frame - 1) / 24.0);
  io::PointCacheWriter writer(path, static_cast<std::size_t>(positions.front().cols()), times);
  for (const Positions& frame : positions) writer.add(points_to_glm(frame));
  writer.commit();
  return path;
}

// Moves free cloth with moving obstacles, in steps so small that an obstacle never overtakes a vertex.
Positions led(const DrapeScene& scene, const shell::Conditions& conditions, double from, double to,
              Positions positions) {
  auto before = scene.obstacles(from);
  const double shortest = std::ldexp(to - from, -12);
  for (double step = to - from; from < to;) {
    const double next = std::min(from + step, to);
    auto after = scene.obstacles(next);
    if (auto moved = shell::followed(before, after, conditions, positions)) {
      positions = std::move(*moved);
      before = std::move(after);
      from = next;
    } else if ((step *= 0.5) < shortest) {
      throw Error(ExitCode::bad_input,
                  fmt::format("obstacles close in on cloth from two sides at load {:.4g}", next));
    }
  }
  return positions;
}

// The anchors of friction, moved with the obstacles.
std::vector<Positions> carried_along(const std::vector<shell::Obstacle>& before,
                                     const std::vector<shell::Obstacle>& after,
                                     std::vector<Positions> anchors) {
  for (std::size_t o = 0; o < anchors.size(); ++o)
    for (Eigen::Index v = 0; v < anchors[o].cols(); ++v)
      if (anchors[o].col(v).allFinite())
        anchors[o].col(v) = shell::carried_along(before[o], after[o], anchors[o].col(v));
  return anchors;
}

DrapeContact contact_of(const std::vector<shell::Obstacle>& obstacles, const shell::Topology& topology,
                        const Positions& positions) {
  DrapeContact contact;
  contact.nearest = std::numeric_limits<double>::max();
  for (Eigen::Index v = 0; v < positions.cols(); ++v) {
    if (topology.component[static_cast<std::size_t>(v)] == shell::none) continue;
    double least = std::numeric_limits<double>::max();
    for (const shell::Obstacle& obstacle : obstacles)
      least = std::min(least, shell::distance(obstacle, positions.col(v)).value);
    if (least <= 0) ++contact.inside;
    contact.deepest = std::max(contact.deepest, -least);
    contact.nearest = std::min(contact.nearest, std::max(least, 0.0));
  }
  return contact;
}

std::filesystem::path frame_file(const std::filesystem::path& pattern, int frame) {
  std::string path = config::frame_path(pattern.string() + ".png", frame);  // patterns are those of pictures
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
  const shell::Topology rest =
      shell::build_topology(scene.rest_faces, static_cast<std::size_t>(scene.rest.cols()));
  shell.rest = shell::rest_faces(scene.rest, scene.rest_faces);
  shell.material = scene.material;
  shell.stretching = scene.stretching;
  shell.bending = scene.bending;
  shell.residual = scene.residual;
  if (scene.rest_flat || scene.bending == shell::Bending::off) return shell;
  // Seams are boundaries of the rest shape and so count as flat.
  auto forms = shell::second_forms(rest, shell.rest, scene.rest);
  double angle = 0;
  for (std::size_t f = 0; f < forms.size(); ++f)
    angle = std::max(angle, forms[f].norm() * std::sqrt(shell.rest[f].area));
  // Six digits in a file give less than 1e-3 for a plane.
  if (angle < 1e-3) return shell;
  shell.rest_forms = std::move(forms);
  shell.bending = shell::Bending::midedge;  // the quadratic model is for flat rest shapes only
  return shell;
}

void write_base(const std::filesystem::path& path, const DrapeScene& scene, const DrapeFrame& frame,
                const Positions& positions) {
  const shell::Conditions conditions = scene.conditions(frame.load);
  WrinkleScene base;
  base.surface = {shell::build_topology(scene.faces, static_cast<std::size_t>(positions.cols())),
                  shell::rest_faces(scene.rest, scene.rest_faces), positions};
  base.material = scene.material;
  for (Eigen::Index v = 0; v < positions.cols(); ++v) base.held.push_back(conditions.held.col(v).all());
  base.chords = scene.chords;
  write_base(path, fmt::format("plisse drape {} load {}", scene.name, frame.load), base,
             frame.equilibrium.converged ? "" : frame.equilibrium.reason);
}

Positions perturbed(const DrapeScene& scene, const shell::Loads& loads, const shell::Conditions& conditions,
                    Positions positions) {
  if (scene.perturb == 0) return positions;
  std::mt19937 random(1);
  for (Eigen::Index v = 0; v < positions.cols(); ++v) {
    Eigen::Vector3d moved = positions.col(v);
    for (int axis = 0; axis < 3; ++axis) {
      const double share = static_cast<double>(random()) / 2147483647.5 - 1;  // −1 … 1, the same everywhere
      if (!conditions.held(axis, v)) moved[axis] += scene.perturb * share;
    }
    const bool touches =
        std::any_of(loads.obstacles.begin(), loads.obstacles.end(), [&](const shell::Obstacle& obstacle) {
          return std::min(shell::distance(obstacle, moved).value,
                          shell::distance(obstacle, positions.col(v)).value) < loads.gap;
        });
    if (!touches) positions.col(v) = moved;
  }
  return positions;
}

double load_of_frame(const DrapeScene& scene, int n) {
  return scene.frames > 1 ? static_cast<double>(n - 1) / (scene.frames - 1) : 1;
}

shell::Equilibrium solve_frame(const DrapeScene& scene, const shell::Shell& shell, int n, DrapeState& state,
                               const SolvedCache& cache, Reuse& reuse,
                               const shell::NewtonProgress& progress) {
  const double load = load_of_frame(scene, n);
  const shell::Conditions conditions = scene.conditions(load);
  shell::Loads& loads = state.loads;
  // `carried` ignores obstacles and could move cloth through them: with obstacles only held vertices move.
  Positions start =
      loads.obstacles.empty() ? shell::carried(shell, conditions, state.positions) : state.positions;
  if (scene.obstacles) {
    start = led(scene, conditions, state.load, load, std::move(start));
    const auto before = std::move(loads.obstacles);
    loads.obstacles = scene.obstacles(load);
    loads.anchors = carried_along(before, loads.obstacles, std::move(loads.anchors));
  }
  if (scene.growing_forces.size() > 0) {
    loads.forces = load * scene.growing_forces;
    if (scene.loads.forces.size() > 0) loads.forces += scene.loads.forces;
  }
  state.load = load;
  shell::Equilibrium found =
      cached_equilibrium(cache, reuse, shell, conditions, loads, perturbed(scene, loads, conditions, start),
                         scene.newton, progress);
  state.positions = found.positions;
  loads.anchors = found.anchors;
  return found;
}

DrapeReport drape(const DrapeRequest& request) {
  const DrapeScene& scene = request.scene;
  const double began = wall_seconds();
  const bool files = request.output.has_value();
  const std::filesystem::path output = request.output.value_or("");
  const bool pattern = config::is_frame_pattern(output.string());
  if (files && output.extension() != ".ply")
    throw Error(ExitCode::bad_input,
                fmt::format("{}: base surfaces are written as PLY; end the name with .ply", output.string()));
  const std::vector<int> picked = request.frames.empty()
                                      ? std::vector<int>{scene.frames}
                                      : config::select_frames(request.frames, scene.frames);
  for (std::size_t k = 2; k < picked.size() && files && !pattern; ++k)
    if (picked[k] - picked[k - 1] != picked[1] - picked[0])
      throw Error(
          ExitCode::bad_input,
          fmt::format("--frames {}: a point cache wants frames evenly spaced; for a file a frame give "
                      "a pattern, such as -o base_####.ply",
                      request.frames));
  if (files) check_writable(pattern ? frame_file(output, picked.front()) : output);

  const shell::Shell shell = shell_of(scene);
  DrapeReport report;
  report.vertices = shell.topology.vertex_count;
  report.faces = shell.topology.faces.size();
  DrapeState state(scene);
  const Positions& positions = state.positions;
  const shell::Loads& loads = state.loads;
  const SolvedCache cache(request.cache);
  Reuse reuse;
  std::vector<int> cached;
  std::vector<Positions> cached_positions;
  const auto write = [&](DrapeFrame frame) {
    if (scene.measures) frame.measures = scene.measures(positions);
    if (!loads.obstacles.empty()) frame.contact = contact_of(loads.obstacles, shell.topology, positions);
    if (files && (pattern || report.frames.empty())) {
      const auto path = pattern ? frame_file(output, frame.frame) : output;
      write_base(path, scene, frame, positions);
      frame.path = path.string();
      report.outputs.push_back(path);
    }
    if (request.on_frame) request.on_frame(frame, positions);
    report.converged &= frame.equilibrium.converged;
    report.frames.push_back(std::move(frame));
  };
  for (int n = 1; n <= picked.back() && !report.interrupted; ++n) {
    DrapeFrame frame;
    frame.frame = n;
    frame.load = load_of_frame(scene, n);
    try {
      frame.equilibrium = solve_frame(scene, shell, n, state, cache, reuse,
                                      [&](const shell::NewtonStep& step, const Positions&) {
                                        if (request.progress) request.progress(n, scene.frames, step);
                                        return !interrupted();
                                      });
    } catch (const Error& error) {
      if (report.frames.empty()) throw;  // no frame is finished yet
      report.failure = fmt::format("frame {}: {}", n, error.what());
      report.failure_code = error.code;
      report.converged = false;
      break;
    }
    report.interrupted = interrupted() && !frame.equilibrium.converged;
    const bool wanted = std::find(picked.begin(), picked.end(), n) != picked.end();
    if (wanted) {
      if (files && !pattern) {
        cached.push_back(n);
        cached_positions.push_back(positions);
      }
    } else if (!report.interrupted) {
      if (!frame.equilibrium.converged)
        log::warn(fmt::format("frame {} on the way did not converge: {}", n, frame.equilibrium.reason));
      continue;
    }
    write(std::move(frame));
  }
  if (cached_positions.size() > 1) report.outputs.push_back(write_cache(output, cached, cached_positions));
  report.from_cache = reuse.answers;
  report.saved_s = reuse.saved_s;
  report.wall_s = wall_seconds() - began;
  report.peak_rss_MiB = peak_rss_MiB();
  return report;
}

}  // namespace plisse::cloth
