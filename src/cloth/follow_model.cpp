#include "cloth/follow_model.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <set>

#include "base/clock.h"
#include "base/eigen_glm.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "config/frames.h"
#include "scene/animation.h"
#include "scene/load_model.h"
#include "scene/wrinkles.h"
#include "wrinkle/facets.h"
#include "wrinkle/local_waves.h"

namespace plisse::cloth {
namespace {

using shell::Face;
using shell::Positions;

// The selected parts' faces as shells: vertices of their own, from those of the model.
struct Cloth {
  std::vector<std::uint32_t> from;  // of each vertex: the welded vertex of the model
  std::vector<Face> faces;

  Positions places(const std::vector<glm::dvec3>& welded) const {
    Positions result(3, static_cast<Eigen::Index>(from.size()));
    for (std::size_t v = 0; v < from.size(); ++v)
      result.col(static_cast<Eigen::Index>(v)) = to_eigen(welded[from[v]]);
    return result;
  }
};

bool has_area(const std::vector<glm::dvec3>& rest, const Face& face) {
  const glm::dvec3 a = rest[face[1]] - rest[face[0]], b = rest[face[2]] - rest[face[0]], c = b - a;
  const double longest = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
  return glm::length(glm::cross(a, b)) > 1e-10 * longest;
}

Cloth selected(const Surface& surface) {
  Cloth cloth;
  std::vector<Face> loose;
  std::set<std::pair<std::uint32_t, std::uint32_t>> sides;  // a side with its direction belongs to one face
  std::size_t flat = 0;
  for (const Part& part : surface.parts) {
    if (!part.wrinkles) continue;
    for (std::uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
      Face face;
      for (std::size_t c = 0; c < 3; ++c)
        face[c] = surface.render_vertices[surface.triangles[3 * t + c]].welded;
      if (!has_area(surface.rest, face)) {
        ++flat;
        continue;
      }
      const auto side = [&](std::size_t c) { return std::pair(face[c], face[(c + 1) % 3]); };
      if (sides.contains(side(0)) || sides.contains(side(1)) || sides.contains(side(2))) {
        loose.push_back(face);
        continue;
      }
      for (std::size_t c = 0; c < 3; ++c) sides.insert(side(c));
      cloth.faces.push_back(face);
    }
  }
  if (cloth.faces.empty())
    throw Error(ExitCode::bad_input, "no triangle is selected that has an area: nothing can wrinkle");
  if (flat > 0) log::warn(fmt::format("{} triangles without area are left out", flat));
  if (!loose.empty())
    log::warn(
        fmt::format("{} faces at edges where more than two faces meet, or that are turned over beside their "
                    "neighbours, are cut loose",
                    loose.size()));
  std::map<std::uint32_t, std::uint32_t> number;
  for (Face& face : cloth.faces)
    for (auto& v : face) {
      const auto [entry, fresh] = number.try_emplace(v, static_cast<std::uint32_t>(cloth.from.size()));
      if (fresh) cloth.from.push_back(v);
      v = entry->second;
    }
  for (Face face : loose) {
    for (auto& v : face) {
      cloth.from.push_back(v);
      v = static_cast<std::uint32_t>(cloth.from.size() - 1);
    }
    cloth.faces.push_back(face);
  }
  return cloth;
}

// One connected shell with its own Λ.
struct Piece {
  std::vector<std::uint32_t> vertices;
  double edge = 0;  // mean rest edge, m
  Positions rest;   // where its vertices are at rest, m
  std::optional<shell::Follower> follower;
};

std::vector<Piece> pieces_of(const shell::Topology& topology, const std::vector<shell::RestFace>& rest,
                             const Positions& rest_positions, const FollowRequest& request, double edges,
                             double& largest) {
  std::vector<Piece> pieces(topology.component_count);
  std::vector<std::uint32_t> local(topology.vertex_count, 0);
  for (std::uint32_t v = 0; v < topology.vertex_count; ++v) {
    Piece& piece = pieces[topology.component[v]];
    local[v] = static_cast<std::uint32_t>(piece.vertices.size());
    piece.vertices.push_back(v);
  }
  std::vector<std::vector<Face>> faces(pieces.size());
  std::vector<std::vector<shell::RestFace>> rests(pieces.size());
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    Face face = topology.faces[f];
    const std::uint32_t piece = topology.component[face[0]];
    for (auto& v : face) v = local[v];
    faces[piece].push_back(face);
    rests[piece].push_back(rest[f]);
  }
  std::vector<std::size_t> count(pieces.size(), 0);
  for (const shell::Edge& edge : topology.edges) {
    const std::uint32_t piece = topology.component[edge.vertex[0]];
    pieces[piece].edge += (rest_positions.col(edge.vertex[0]) - rest_positions.col(edge.vertex[1])).norm();
    ++count[piece];
  }
  std::size_t most = 0;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    Piece& piece = pieces[p];
    piece.edge /= static_cast<double>(std::max<std::size_t>(count[p], 1));
    Positions places(3, static_cast<Eigen::Index>(piece.vertices.size()));
    for (std::size_t v = 0; v < piece.vertices.size(); ++v)
      places.col(static_cast<Eigen::Index>(v)) = rest_positions.col(piece.vertices[v]);
    shell::FollowSettings settings;
    settings.wavelength = request.follow.value_or(edges * piece.edge);
    settings.tension_limit = request.tension_limit;
    if (request.material) settings.poisson = request.material->poisson;
    if (faces[p].size() > most) {
      most = faces[p].size();
      largest = settings.wavelength;
    }
    const std::size_t vertex_count = piece.vertices.size();
    piece.follower.emplace(shell::build_topology(std::move(faces[p]), vertex_count), std::move(rests[p]),
                           places, settings);
    piece.rest = std::move(places);
  }
  return pieces;
}

// Whether the pose is the rest shape moved, turned and scaled as a whole, to the digits of single precision
// that models have.
bool similar(const Positions& rest, const Positions& pose) {
  const Eigen::Matrix4d moved = Eigen::umeyama(rest, pose, true);
  if (!moved.allFinite()) return false;
  const Positions there = (moved.topLeftCorner<3, 3>() * rest).colwise() + moved.topRightCorner<3, 1>();
  const double size = pose.cwiseAbs().maxCoeff() + moved.cwiseAbs().maxCoeff() * rest.cwiseAbs().maxCoeff();
  return (there - pose).cwiseAbs().maxCoeff() <= 1e-6 * size;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

// The thickness at which the waves of the squeezed area have the wavelength, in the median by area times
// compression: h² = 12(1 − ν²) K/|ω|⁴, K the stiffness that curvature and tension of the base give
// (local_waves.h), whatever h is. Young's modulus multiplies all energies alike.
shell::Material material_for(double wavelength, double tension_limit, const wrinkle::BaseSurface& surface,
                             const std::vector<Positions>& bases) {
  shell::Material material;
  material.young = 1e5;
  material.poisson = 0.3;
  // Cloth thicker than a tenth of its waves is no thin shell; thinner than the other, waves are as long as
  // their patch in any case.
  const double thickest = 0.1 * wavelength, thinnest = 1e-4 * wavelength;
  material.thickness = thinnest;
  std::vector<std::pair<double, double>> stiffness;  // K, weight
  double sum = 0;
  for (const Positions& positions : bases) {
    wrinkle::BaseSurface frame = surface;
    frame.positions = positions;
    auto forms = wrinkle::face_forms(frame);
    wrinkle::limit_tension(forms, material, tension_limit);
    wrinkle::find_noise(forms, frame, material, false);
    const auto free = wrinkle::wrinkle_free_faces(forms, frame.topology, wrinkle::WrinkleFreeRule::paper);
    std::vector<bool> live;
    for (const bool f : free) live.push_back(!f);
    const auto waves =
        wrinkle::local_waves(forms, frame.topology, live,
                             std::vector<bool>(frame.topology.vertex_count, false), wrinkle::Model{material});
    for (std::size_t f = 0; f < waves.size(); ++f) {
      const double weight = live[f] ? forms[f].rest.area * std::max(waves[f].compression, 0.0) : 0;
      if (!(weight > 0)) continue;
      stiffness.emplace_back(waves[f].stiffness, weight);
      sum += weight;
    }
  }
  std::sort(stiffness.begin(), stiffness.end());
  double below = 0, middle = 0;
  for (const auto& [value, weight] : stiffness) {
    below += weight;
    middle = value;
    if (below >= sum / 2) break;
  }
  const double rate = 2 * std::numbers::pi / wavelength, poisson = material.poisson,
               wanted = std::sqrt(12 * (1 - poisson * poisson) * std::max(middle, 0.0)) / (rate * rate);
  if (wanted > thickest)
    log::warn(fmt::format(
        "waves {:.3g} m long would need cloth {:.3g} m thick on a surface so curved or so tense, and "
        "get {:.3g} m: they come out shorter; a smaller --wavelength or a larger --follow helps",
        wavelength, wanted, thickest));
  material.thickness = std::clamp(wanted, thinnest, thickest);
  return material;
}

}  // namespace

FollowReport follow_model(const FollowRequest& request) {
  const io::Model model = scene::load_model(request.scene);
  const config::ModelSettings& chosen = request.scene.model;
  scene::Animation animation(
      model, {chosen.clip, chosen.frames_per_second, chosen.rest, chosen.loop, request.scene.limits});
  scene::select_parts(animation.surface(), request.scene.wrinkles);
  const Surface& surface = animation.surface();

  FollowReport report;
  report.picked = config::select_frames(request.frames.empty() ? chosen.frames : request.frames,
                                        animation.timeline().frame_count);
  const Cloth cloth = selected(surface);
  WrinkleScene& first = report.first;
  first.name = chosen.path.stem().string();
  first.chords = false;
  first.tension_limit = request.tension_limit;
  first.surface.topology = shell::build_topology(cloth.faces, cloth.from.size());
  const Positions rest_positions = cloth.places(surface.rest);
  first.surface.rest = shell::rest_faces(rest_positions, cloth.faces);
  first.held.assign(cloth.from.size(), false);
  report.shells = first.surface.topology.component_count;

  // The thickness is the clip's and not that of the frames picked: a few of them, evenly, are followed as
  // well.
  constexpr int samples = 8;
  std::set<int> wanted, sampled;
  for (int n = report.picked.front(); n <= report.picked.back(); ++n) wanted.insert(n);
  const int last = animation.timeline().frame_count;
  for (int k = 0; k < samples && !request.material; ++k) sampled.insert(1 + k * (last - 1) / (samples - 1));
  wanted.insert(sampled.begin(), sampled.end());

  // Poses one after the other, since an animation remembers what was last finite; bases on all cores.
  std::vector<Positions> poses;
  bool simulated = false;
  std::vector<FollowedFrame> frames;
  for (const int n : wanted) {
    const scene::Pose pose = animation.pose(n);
    simulated = simulated || !pose.cache.empty();
    poses.push_back(cloth.places(scene::posed(surface, pose)));
    frames.push_back({.frame = n});
  }
  const std::vector<Piece> pieces = pieces_of(first.surface.topology, first.surface.rest, rest_positions,
                                              request, simulated ? 8 : 4, report.follow);
  std::vector<Positions> bases(poses.size());
  std::atomic<int> done = 0;
  std::mutex telling;
  tbb::parallel_for(std::size_t{0}, poses.size(), [&](std::size_t n) {
    if (interrupted()) return;
    const double began = wall_seconds();
    FollowedFrame& frame = frames[n];
    Positions base = poses[n];
    double squares = 0;
    frame.converged = true;
    for (const Piece& piece : pieces) {
      if (interrupted()) return;
      Positions pose(3, static_cast<Eigen::Index>(piece.vertices.size()));
      for (std::size_t v = 0; v < piece.vertices.size(); ++v)
        pose.col(static_cast<Eigen::Index>(v)) = poses[n].col(piece.vertices[v]);
      if (similar(piece.rest, pose)) {
        ++frame.still;
        continue;
      }
      const shell::Followed followed = piece.follower->follow(pose);
      for (std::size_t v = 0; v < piece.vertices.size(); ++v)
        base.col(piece.vertices[v]) = followed.base.col(static_cast<Eigen::Index>(v));
      squares += followed.moved_rms * followed.moved_rms * static_cast<double>(piece.vertices.size());
      frame.moved_most = std::max(frame.moved_most, followed.moved_most);
      frame.iterations += followed.iterations;
      frame.converged = frame.converged && followed.converged;
    }
    frame.moved_rms = std::sqrt(squares / static_cast<double>(base.cols()));
    std::vector<double> kept;
    for (const shell::Edge& edge : first.surface.topology.edges) {
      const auto length = [&](const Positions& x) {
        return (x.col(edge.vertex[0]) - x.col(edge.vertex[1])).norm();
      };
      kept.push_back(length(base) / length(rest_positions));
    }
    frame.length_kept = median(std::move(kept));
    bases[n] = std::move(base);
    frame.seconds = wall_seconds() - began;
    const int now = ++done;
    if (request.progress) {
      const std::lock_guard lock(telling);
      request.progress(now, static_cast<int>(poses.size()));
    }
  });
  report.interrupted = interrupted();
  if (report.interrupted) return report;
  std::vector<Positions> of_clip;
  for (std::size_t n = 0; n < bases.size(); ++n) {
    const int number = frames[n].frame;
    if (sampled.contains(number)) of_clip.push_back(bases[n]);
    if (number < report.picked.front() || number > report.picked.back()) continue;
    report.frames.push_back(frames[n]);
    report.bases.push_back(std::move(bases[n]));
  }
  first.surface.positions = report.bases.front();
  std::size_t most = 0;
  double edge = 0;
  for (const Piece& piece : pieces)
    if (piece.vertices.size() > most) {  // the same shell as report.follow's, but where two are as large
      most = piece.vertices.size();
      edge = piece.edge;
    }
  report.wavelength = request.wavelength.value_or(3 * edge);
  first.material = request.material
                       ? *request.material
                       : material_for(report.wavelength, request.tension_limit, first.surface, of_clip);
  return report;
}

}  // namespace plisse::cloth
