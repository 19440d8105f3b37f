#include "cloth/solve_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/eigen_glm.h"
#include "cloth/cached_answer.h"
#include "cloth/wrinkle_sequence.h"
#include "config/frames.h"

namespace plisse::cloth {

// The field of a frame, as the cache has it.
struct KnownField {
  SolvedClip::Frame drawn;  // without its base
  double waves = 0, max_amplitude = 0, solve_s = 0;
  wrinkle::TakeUp taken;
  bool converged = true;
  std::string reason;
};

void members(auto& a, Is<KnownField> auto& value) {
  auto& [drawn, waves, max_amplitude, solve_s, taken, converged, reason] = value;
  auto& [base, amplitude, phase] = drawn;
  auto& [compression, untaken, wavelength, crest_angle, where_compressed] = taken;
  a(amplitude, phase, waves, max_amplitude, solve_s, compression, untaken, wavelength, crest_angle,
    where_compressed, converged, reason);
}

namespace {

// Corners in the order of the surface's triangles.
template <typename Three>
Three as_triangle(Three corners, bool turned) {
  if (turned) std::swap(corners[1], corners[2]);
  return corners;
}

SolvedClip clip_of(const FollowReport& followed) {
  const Cloth& cloth = followed.cloth;
  SolvedClip clip;
  clip.welded = cloth.welded;
  clip.triangle = cloth.triangle;
  for (std::size_t f = 0; f < cloth.faces.size(); ++f)
    clip.faces.push_back(as_triangle(cloth.faces[f], cloth.turned[f]));
  for (const shell::Positions& base : followed.bases) clip.frames.push_back({points_to_glm(base), {}, {}});
  return clip;
}

void take(const KnownField& known, SolvedClip::Frame& drawn, SolvedFrame& report) {
  drawn.amplitude = known.drawn.amplitude;
  drawn.phase = known.drawn.phase;
  report.waves = known.waves;
  report.max_amplitude = known.max_amplitude;
  report.taken = known.taken;
  report.solve_s = known.solve_s;
  if (known.converged) return;
  report.converged = false;
  report.reason = known.reason;
}

// Everything that the fields of the clip depend on.
Hash fields_hash(const FollowReport& followed) {
  Hash hash = SolvedCache::question("fields of a clip");
  Hasher hasher(hash);
  const WrinkleScene& first = followed.first;
  const shell::Material& material = first.material;
  hasher(first.surface.topology.faces, material.young, material.poisson, material.thickness,
         first.tension_limit);
  for (const shell::RestFace& face : first.surface.rest) hasher(face.edges);
  for (const shell::Positions& base : followed.strained) hasher(base);
  hasher(followed.room);
  return hash;
}

}  // namespace

SolvedScene solve_scene(const SolveRequest& request) {
  const config::SceneSettings& scene = request.scene;
  SolvedScene solved;
  const auto told = [&](std::string_view what, int done, int of) {
    if (request.progress) request.progress(what, done, of);
  };
  FollowReport followed =
      follow_model({scene, request.cache, [&](int done, int of) { told("followed", done, of); }});
  solved.reuse = followed.reuse;
  solved.interrupted = followed.interrupted;
  if (solved.interrupted) return solved;
  solved.vertices = followed.cloth.welded.size();
  solved.faces = followed.cloth.faces.size();
  solved.shells = followed.shells;
  solved.follow = followed.follow;
  solved.thickness = followed.first.material.thickness;
  const int count = static_cast<int>(followed.frames.size());
  const int last = config::select_frames(scene.model.frames, count).back();
  for (int n = 0; n < last; ++n) {
    const auto index = static_cast<std::size_t>(n);
    SolvedFrame frame;
    frame.followed = followed.frames[index];
    frame.converged = frame.followed.converged;
    if (!frame.converged) frame.reason = "its base surface did not converge";
    solved.frames.push_back(std::move(frame));
  }
  auto clip = std::make_shared<SolvedClip>(clip_of(followed));
  solved.memory.model = followed.model;
  solved.memory.solved = clip;
  if (scene.solve.method == config::SolveMethod::passes) return solved;

  const SolvedCache cache(request.cache);
  const Hash clip_hash = fields_hash(followed).add(scene.solve.quality);
  const auto question = [&](int frame) { return Hash(clip_hash).add(frame); };
  bool all = cache.on();
  Reuse fields_reuse;  // counted only where it spares the solve
  for (int n = 1; n <= last && all; ++n) {
    const auto known = answered<KnownField>(cache, question(n), fields_reuse);
    all = known.has_value();
    if (known)
      take(*known, clip->frames[static_cast<std::size_t>(n - 1)],
           solved.frames[static_cast<std::size_t>(n - 1)]);
  }
  if (all) {
    solved.reuse.answers += fields_reuse.answers;
    solved.reuse.saved_s += fields_reuse.saved_s;
    warn_of_bases(followed.first, followed.strained, last);
    return solved;
  }

  WrinkleSequenceRequest fields;
  fields.each.scene = followed.first;
  fields.poses = std::move(followed.strained);
  fields.room = std::move(followed.room);
  if (scene.solve.quality == config::SolveQuality::draft) fields.quality = wrinkle::Quality::draft;
  fields.frames = fmt::format("1-{}", last);
  fields.on_field = [&](const WrinkleSequenceFrame& frame, const wrinkle::CoarseField& field) {
    KnownField found;
    found.drawn.amplitude.assign(field.amplitude.begin(), field.amplitude.end());
    for (std::size_t f = 0; f < field.phase.size(); ++f)
      found.drawn.phase.push_back(as_triangle(field.phase[f], followed.cloth.turned[f]));
    found.waves = frame.solved.waves;
    found.max_amplitude = frame.max_amplitude;
    found.solve_s = frame.solved.solve_s;
    found.taken = frame.taken;
    found.converged = frame.solved.converged;
    found.reason = frame.solved.reason;
    const auto index = static_cast<std::size_t>(frame.frame - 1);
    take(found, clip->frames[index], solved.frames[index]);
    if (cache.on()) keep(cache, question(frame.frame), found, std::max(found.solve_s, worth_keeping_s));
  };
  fields.progress = [&](bool keys, int done, int of) {
    told(keys ? "key frames solved" : "solved", done, of);
  };
  solved.interrupted = wrinkle_sequence(fields).interrupted;
  return solved;
}

}  // namespace plisse::cloth
