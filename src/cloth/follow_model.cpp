#include "cloth/follow_model.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <mutex>
#include <numbers>

#include "base/clock.h"
#include "base/eigen_glm.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/weighted_median.h"
#include "cloth/archive.h"
#include "cloth/fabric_material.h"
#include "cloth/keep_outside.h"
#include "cloth/uv_rest.h"
#include "config/fabric.h"
#include "config/rest_choice.h"
#include "scene/animation.h"
#include "scene/load_model.h"
#include "scene/moving_body.h"
#include "scene/wrinkles.h"
#include "shell/follow.h"
#include "wrinkle/facets.h"
#include "wrinkle/local_waves.h"

namespace plisse::cloth {
namespace {

using shell::Face;
using shell::Positions;

// One connected shell with its own Λ.
struct Piece {
  std::vector<std::uint32_t> vertices;
  double edge = 0;  // mean rest edge, m
  Positions rest;   // where its vertices are at rest, m; empty: in flat panels
  shell::FollowSettings settings;
  std::optional<shell::Follower> follower;
  std::optional<ShellPoints> points;  // where there are bodies

  Positions part_of(const Positions& of_all) const {
    Positions result(3, static_cast<Eigen::Index>(vertices.size()));
    for (std::size_t v = 0; v < vertices.size(); ++v)
      result.col(static_cast<Eigen::Index>(v)) = of_all.col(vertices[v]);
    return result;
  }
};

// How long each edge is at rest, m; of panels' seams by its first face.
std::vector<double> rest_lengths(const wrinkle::BaseSurface& surface) {
  std::vector<double> lengths;
  for (const shell::Edge& edge : surface.topology.edges) {
    const std::uint32_t f = edge.face[0];
    Eigen::Matrix<double, 2, 3> corner;
    corner << Eigen::Vector2d::Zero(), surface.rest[f].edges;
    const Face& face = surface.topology.faces[f];
    const auto place = [&](std::uint32_t v) {
      return corner.col(std::find(face.begin(), face.end(), v) - face.begin()).eval();
    };
    lengths.push_back((place(edge.vertex[0]) - place(edge.vertex[1])).norm());
  }
  return lengths;
}

// rest_positions: empty where the rest shape is flat panels.
std::vector<Piece> pieces_of(const wrinkle::BaseSurface& surface, const Positions& rest_positions,
                             const config::SolveSettings& solve, double poisson, double edges,
                             const std::vector<bool>& held, bool bodies, double& largest) {
  const shell::Topology& topology = surface.topology;
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
    rests[piece].push_back(surface.rest[f]);
  }
  std::vector<std::size_t> count(pieces.size(), 0);
  const std::vector<double> lengths = rest_lengths(surface);
  for (std::size_t e = 0; e < lengths.size(); ++e) {
    const std::uint32_t piece = topology.component[topology.edges[e].vertex[0]];
    pieces[piece].edge += lengths[e];
    ++count[piece];
  }
  std::size_t most = 0;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    Piece& piece = pieces[p];
    piece.edge /= static_cast<double>(std::max<std::size_t>(count[p], 1));
    if (rest_positions.size() > 0) piece.rest = piece.part_of(rest_positions);
    shell::FollowSettings& settings = piece.settings;
    settings.wavelength = solve.follow >= 0 ? solve.follow : edges * piece.edge;
    settings.tension_limit = solve.tension_limit;
    settings.poisson = poisson;
    // Without a curvature of its own a tube of twelve panels keeps 1 − .165^passes of its radius: what
    // five leave (1e-4) seeds no waves, what two leave (3 %) does.
    if (rest_positions.size() == 0) settings.passes = 5;
    if (faces[p].size() > most) {
      most = faces[p].size();
      largest = settings.wavelength;
    }
    const std::size_t vertex_count = piece.vertices.size();
    std::vector<bool> own_held;
    for (const std::uint32_t v : piece.vertices) own_held.push_back(held[v]);
    shell::Topology own = shell::build_topology(std::move(faces[p]), vertex_count);
    if (bodies) piece.points.emplace(own, rests[p]);
    piece.follower.emplace(std::move(own), std::move(rests[p]), piece.rest, settings, std::move(own_held));
  }
  return pieces;
}

// The factor by which the pose is the rest shape scaled as a whole, moved and turned, to the digits of single
// precision that models have; 0: it is not.
double similar(const Positions& rest, const Positions& pose) {
  if (rest.size() == 0) return 0;  // panels lie flat, and are sewn
  const Eigen::Matrix4d moved = Eigen::umeyama(rest, pose, true);
  if (!moved.allFinite()) return 0;
  const Positions there = (moved.topLeftCorner<3, 3>() * rest).colwise() + moved.topRightCorner<3, 1>();
  const double size = pose.cwiseAbs().maxCoeff() + moved.cwiseAbs().maxCoeff() * rest.cwiseAbs().maxCoeff();
  return (there - pose).cwiseAbs().maxCoeff() <= 1e-6 * size ? moved.topLeftCorner<3, 1>().norm() : 0;
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
  // Thicker cloth is felt: it takes a compression of h²ω²/6 = .26 % before it folds at all. In cloth thinner
  // than the other, waves are as long as their patch in any case.
  const double thickest = 0.02 * wavelength, thinnest = 1e-4 * wavelength;
  material.thickness = thinnest;
  std::vector<std::pair<double, double>> stiffness;  // K, weight
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
      if (weight > 0) stiffness.emplace_back(waves[f].stiffness, weight);
    }
  }
  const double middle = weighted_median(std::move(stiffness));
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

// The bodies of a scene, frame by frame, for shells that are to stay outside.
class ScenesBodies {
 public:
  ScenesBodies(const config::SceneSettings& scene, const Surface& surface, const scene::Timeline& clip)
      : surface_(surface) {
    for (const std::string& name : scene.solve.bodies)
      sources_.emplace_back(scene, surface, clip, name, "--body");
  }
  bool any() const { return !sources_.empty(); }

  // Of the next frame; frames in order. `welded`: places of the surface's welded vertices.
  void add(int frame, const std::vector<glm::dvec3>& welded) {
    auto& all = frames_.emplace_back();
    for (std::size_t b = 0; b < sources_.size(); ++b) {
      const bool same = !sources_[b].own() && !sources_[b].moves() && frame > 1;
      all.push_back(same ? frames_.front()[b]
                         : std::make_shared<const scene::MovingBody::Triangles>(
                               sources_[b].at(frame, surface_, welded)));
    }
  }

  // m, in a frame. Throws Error(bad_input) where one is open.
  std::vector<shell::TriangleBody> at(std::size_t frame, const config::SolveSettings& solve) const {
    std::vector<shell::TriangleBody> bodies;
    for (std::size_t b = 0; b < sources_.size(); ++b) {
      const scene::MovingBody::Triangles& found = *frames_[frame][b];
      bodies.emplace_back(points_to_eigen(found.places), found.triangles, "--body " + solve.bodies[b]);
    }
    return bodies;
  }
  void hash(Hasher& hasher, std::size_t frame) const {
    for (const auto& body : frames_[frame]) hasher(points_to_eigen(body->places), body->triangles);
  }

 private:
  const Surface& surface_;
  std::deque<scene::MovingBody> sources_;  // which do not move in memory
  std::vector<std::vector<std::shared_ptr<const scene::MovingBody::Triangles>>> frames_;
};

// What keeps the shells of a frame outside its bodies; null bodies: nothing.
struct Keeping {
  const std::vector<shell::TriangleBody>* bodies = nullptr;
  double gap = 0;        // m
  Eigen::VectorXd lift;  // m, of all vertices; empty: none
};

Bodies pointers_to(const std::vector<shell::TriangleBody>& bodies) {
  Bodies result;
  for (const shell::TriangleBody& body : bodies) result.push_back(&body);
  return result;
}

// Each shell's base; a shell that is only moved as a whole is its own, and has no value.
std::vector<shell::Followed> follow(const std::vector<Piece>& pieces, const Positions& pose,
                                    const Keeping& keeping) {
  std::vector<shell::Followed> result;
  for (const Piece& piece : pieces) {
    if (interrupted()) return {};
    const Positions own = piece.part_of(pose);
    if (similar(piece.rest, own) > 0) {
      result.emplace_back().converged = true;
    } else if (keeping.bodies == nullptr) {
      result.push_back(piece.follower->follow(own));
    } else {
      Eigen::VectorXd lift(keeping.lift.size() > 0 ? static_cast<Eigen::Index>(piece.vertices.size()) : 0);
      for (Eigen::Index v = 0; v < lift.size(); ++v)
        lift[v] = keeping.lift[piece.vertices[static_cast<std::size_t>(v)]];
      const Bodies bodies = pointers_to(*keeping.bodies);
      KeptOutside kept = follow_outside(*piece.follower, *piece.points, own,
                                        Clearance(*piece.points, own, bodies), bodies, keeping.gap, lift);
      kept.followed.converged = kept.followed.converged && kept.outside;
      result.push_back(std::move(kept.followed));
    }
    if (interrupted()) return {};
  }
  return result;
}

Positions put_together(const std::vector<Piece>& pieces, const std::vector<shell::Followed>& followed,
                       Positions base, FollowedFrame& frame) {
  double squares = 0;
  frame.converged = true;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const shell::Followed& part = followed[p];
    frame.converged = frame.converged && part.converged;
    if (part.base.size() == 0) {
      ++frame.still;
      continue;
    }
    for (std::size_t v = 0; v < pieces[p].vertices.size(); ++v)
      base.col(pieces[p].vertices[v]) = part.base.col(static_cast<Eigen::Index>(v));
    squares += part.moved_rms * part.moved_rms * static_cast<double>(pieces[p].vertices.size());
    frame.moved_most = std::max(frame.moved_most, part.moved_most);
    frame.iterations += part.iterations;
  }
  frame.moved_rms = std::sqrt(squares / static_cast<double>(base.cols()));
  return base;
}

// How near the shells of a frame come to its bodies, and how high waves may be there.
void find_room(const std::vector<Piece>& pieces, const Positions& pose, const Positions& base,
               const Bodies& bodies, std::vector<double>& room, FollowedFrame& frame) {
  room.assign(static_cast<std::size_t>(base.cols()), INFINITY);
  for (const Piece& piece : pieces) {
    const Clearance clearance(*piece.points, piece.part_of(pose), bodies);
    // Vertices come first.
    frame.brought_out += static_cast<int>(
        std::count_if(clearance.distance.begin(),
                      clearance.distance.begin() + static_cast<std::ptrdiff_t>(piece.vertices.size()),
                      [](double distance) { return distance < 0; }));
    const double reach = std::max(piece.settings.wavelength, piece.edge) / 4;  // waves are not so high
    double nearest = reach;
    const std::vector<double> own =
        room_of(*piece.points, clearance, piece.part_of(base), bodies, reach, nearest);
    frame.nearest_body = frame.nearest_body > 0 ? std::min(frame.nearest_body, nearest) : nearest;
    for (std::size_t v = 0; v < own.size(); ++v) room[piece.vertices[v]] = own[v];
  }
}

// A base surface on which shells that are scaled as a whole have their rest shape's size: else that would be
// strain.
Positions unscaled(const std::vector<Piece>& pieces, Positions base) {
  for (const Piece& piece : pieces) {
    const Positions own = piece.part_of(base);
    const double scale = similar(piece.rest, own);
    if (scale == 0 || std::abs(scale - 1) <= 1e-6) continue;
    const Eigen::Vector3d middle = own.rowwise().mean();
    for (std::size_t v = 0; v < piece.vertices.size(); ++v)
      base.col(piece.vertices[v]) = middle + (own.col(static_cast<Eigen::Index>(v)) - middle) / scale;
  }
  return base;
}

double length_kept(const shell::Topology& topology, const std::vector<double>& rest, const Positions& base) {
  std::vector<double> kept;
  for (std::size_t e = 0; e < rest.size(); ++e) {
    const auto& [a, b] = topology.edges[e].vertex;
    kept.push_back((base.col(a) - base.col(b)).norm() / rest[e]);
  }
  return median(std::move(kept));
}

// Everything that the bases depend on beside the pose.
Hash shells_hash(const wrinkle::BaseSurface& surface, const Positions& rest_positions,
                 const std::vector<bool>& held, const std::vector<Piece>& pieces) {
  Hash hash = SolvedCache::question("bases");
  Hasher hasher(hash);
  hasher(surface.topology.faces, rest_positions, held);
  if (rest_positions.size() == 0)
    for (const shell::RestFace& face : surface.rest) hasher(face.edges);
  for (const Piece& piece : pieces) hasher(piece.settings.wavelength);
  hasher(pieces.front().settings.tension_limit, pieces.front().settings.poisson);
  return hash;
}

// Throws Error(bad_input) where the rest shape has another unit than the motion: no cloth is stretched, or
// shrinks, by that much everywhere and always.
void check_scale(const wrinkle::BaseSurface& surface, const std::vector<Positions>& bases) {
  constexpr double most = 10;
  std::vector<double> stretch;
  const std::size_t step = std::max<std::size_t>(bases.size() / 16, 1);  // some frames tell
  for (std::size_t n = 0; n < bases.size(); n += step)
    for (std::size_t f = 0; f < surface.rest.size(); ++f) {
      const shell::Principal strain =
          shell::principal_strain(surface.rest[f], shell::corners_of(surface.topology.faces[f], bases[n]));
      stretch.push_back(std::sqrt(std::max(1 + strain.value[0], 0.0)));
    }
  const double middle = median(std::move(stretch));
  if (middle > 1 / most && middle < most) return;
  throw Error(
      ExitCode::bad_input,
      fmt::format("the model in motion is {:.3g} times as large as its rest shape, and both should be "
                  "in metres: another --rest, or --units for its file, is wanted",
                  middle));
}

}  // namespace

FollowReport follow_model(const FollowRequest& request) {
  const config::ModelSettings& chosen = request.scene.model;
  const config::SolveSettings& solve = request.scene.solve;
  std::optional<shell::Material> fabric;
  if (!solve.fabric.empty()) fabric = material_of(config::parse_fabric(solve.fabric), {}, {}).material;
  FollowReport report;
  report.model = std::make_shared<const io::Model>(scene::load_model(request.scene));
  scene::Animation animation(
      *report.model, {chosen.clip, chosen.frames_per_second, chosen.rest, chosen.loop, request.scene.limits});
  scene::select_parts(animation.surface(), request.scene.wrinkles, solve.bodies);
  const Surface& surface = animation.surface();
  ScenesBodies bodies(request.scene, surface, animation.timeline());
  report.welded = static_cast<int>(surface.vertex_count());

  report.cloth = cloth_of(surface);
  const Cloth& cloth = report.cloth;
  if (cloth.without_area > 0)
    log::warn(fmt::format("{} triangles without area are left out", cloth.without_area));
  if (cloth.cut > 0)
    log::warn(
        fmt::format("sheets of cloth are parted at {} edges where faces do not fit together", cloth.cut));
  WrinkleScene& first = report.first;
  first.name = chosen.path.empty() ? chosen.garment.stem().string() : chosen.path.stem().string();
  first.chords = false;
  first.tension_limit = solve.tension_limit;
  first.surface.topology = shell::build_topology(cloth.faces, cloth.welded.size());
  Positions rest_positions;
  if (const auto uv = config::uv_rest_choice(chosen.rest)) {
    UvRest rest = rest_from_uv(surface, cloth, uv->metres, report.model->path.string());
    if (!uv->metres)
      log::notice(fmt::format("a unit of uv is {:.4g} m, by the area of the model at rest", rest.metres));
    first.surface.rest = std::move(rest.faces);
  } else {
    rest_positions = cloth.places(surface.rest);
    first.surface.rest = shell::rest_faces(rest_positions, cloth.faces);
  }
  first.held = cloth.shared;  // parts that are not selected stay as they are
  report.shells = first.surface.topology.component_count;
  first.look = std::make_shared<ClothLook>(look_of(*report.model, surface, cloth));

  // Poses one after the other, since an animation remembers what was last finite; bases on all cores.
  const int last = animation.timeline().frame_count;
  const auto count = static_cast<std::size_t>(last);
  std::vector<Positions> poses;
  bool simulated = false;
  for (int n = 1; n <= last && !interrupted(); ++n) {
    const scene::Pose pose = animation.pose(n);
    simulated = simulated || !pose.cache.empty();
    const std::vector<glm::dvec3> welded = scene::posed(surface, pose);
    poses.push_back(cloth.places(welded));
    if (bodies.any()) bodies.add(n, welded);
    report.frames.push_back({.frame = n});
  }
  const shell::Material material = fabric.value_or(shell::Material{.young = 1e5, .poisson = 0.3});
  const std::vector<Piece> pieces = pieces_of(first.surface, rest_positions, solve, material.poisson,
                                              simulated ? 8 : 4, first.held, bodies.any(), report.follow);
  const std::vector<double> lengths = rest_lengths(first.surface);
  double edge = 0;
  for (std::size_t most = 0; const Piece& piece : pieces)
    if (piece.vertices.size() > most) {  // the same shell as report.follow's, but where two are as large
      most = piece.vertices.size();
      edge = piece.edge;
    }
  const double gap = solve.gap >= 0 ? solve.gap : std::max(fabric ? fabric->thickness / 2 : 0, edge / 50);
  const SolvedCache cache(request.cache);
  const Hash shells = shells_hash(first.surface, rest_positions, first.held, pieces);
  report.bases.resize(count);
  report.strained.resize(count);
  if (bodies.any()) report.room.resize(count);
  int done = 0;
  std::mutex telling;
  // `lifted`: once more, where a body is near, with room for the waves that the surface would have.
  const auto follow_all = [&](bool lifted) {
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t n) {
      if (interrupted()) return;
      const double began = wall_seconds();
      FollowedFrame& frame = report.frames[n];
      std::vector<shell::TriangleBody> of_frame;
      Keeping keeping;
      Hash question = shells;
      if (bodies.any()) {
        of_frame = bodies.at(n, solve);
        keeping = {&of_frame, gap, {}};
        Hasher hasher(question);
        bodies.hash(hasher, n);
        hasher(gap);
        if (lifted) {
          WrinkleRequest each;
          each.scene = first;
          each.scene.surface.positions = report.strained[n];
          keeping.lift = wanted_heights(each.scene.surface, forms_of(each), first.material);
          hasher(keeping.lift);
        }
      }
      Reuse reuse;
      const auto followed =
          cached_bases(cache, reuse, question, poses[n], [&] { return follow(pieces, poses[n], keeping); });
      if (interrupted()) return;
      frame = {.frame = frame.frame, .seconds = frame.seconds};
      report.bases[n] = put_together(pieces, followed, poses[n], frame);
      report.strained[n] = unscaled(pieces, report.bases[n]);
      frame.length_kept = length_kept(first.surface.topology, lengths, report.strained[n]);
      if (bodies.any() && lifted)
        find_room(pieces, poses[n], report.bases[n], pointers_to(of_frame), report.room[n], frame);
      frame.seconds += wall_seconds() - began;
      const std::lock_guard lock(telling);
      report.reuse.answers += reuse.answers;
      report.reuse.saved_s += reuse.saved_s;
      if (request.progress) request.progress(++done, (bodies.any() ? 2 : 1) * last);
    });
    report.interrupted = interrupted();
  };
  follow_all(false);
  if (report.interrupted) return report;
  check_scale(first.surface, report.strained);

  first.surface.positions = report.bases.front();
  report.wavelength = request.scene.wrinkles.wavelength > 0 ? request.scene.wrinkles.wavelength : 3 * edge;
  if (fabric) {
    first.material = *fabric;
  } else {
    constexpr int samples = 8;  // evenly over the clip
    std::vector<Positions> of_clip;
    for (int k = 0; k < samples; ++k) {
      const auto n = static_cast<std::size_t>(k * (last - 1) / (samples - 1));
      if (k == 0 || n != static_cast<std::size_t>((k - 1) * (last - 1) / (samples - 1)))
        of_clip.push_back(report.strained[n]);
    }
    first.material = material_for(report.wavelength, solve.tension_limit, first.surface, of_clip);
  }
  if (bodies.any()) {
    follow_all(true);
    first.surface.positions = report.bases.front();
    const auto inside = std::ranges::find_if(report.frames, [](const auto& f) { return f.brought_out > 0; });
    if (inside != report.frames.end())
      log::warn(
          fmt::format("frame {}: {} vertices of the cloth are inside a body as the model has it, and are "
                      "brought out; other frames are the report's 'brought_out'",
                      inside->frame, inside->brought_out));
  }
  return report;
}

}  // namespace plisse::cloth
