#include "pipeline/verify_waves.h"

#include <cmath>

#include "reference/functions.h"

namespace plisse::pipeline {
namespace {

using Eigen::Index;
using reference::Status;

// --- tolerances, and why ---------------------------------------------------------------------------------
// Single precision has a relative error of 6e-8; a sum over eight influences of products of three has about
// ten times that.
constexpr double skin_tolerance = 1e-6;  // of the bounding box
// n' and t' come from differences of positions, whose relative error is larger by the ratio of box to edge,
// 1e2 and more: 1e-7 / 1e-2, times ten.
constexpr double frame_tolerance = 1e-4;  // of a unit vector, where the areas do not cancel below 1e-2
// The same differences, squared by the regression.
constexpr double r_tolerance = 1e-5;
// dh/dr = (W/4) r/√(1−r²): 2.5 at the edge of the default dead zone.
constexpr double height_tolerance = 1e-5;  // of W, outside the dead zone
// Inside it the easing is steep: dh/dr reaches (W/4)√(2δ) · 3/δ, 15 W at δ = .005, times errors of 1e-6 in r.
constexpr double easing_tolerance = 1e-4;  // of W
// w rises by 1 over h/W = .0625: sixteen times the larger of the two.
constexpr double weight_tolerance = 1.6e-3;
// The error of a direction is inversely proportional to the gap between the singular values: 1e-6 over the
// gap, here weighted by the gap.
constexpr double wave_vector_tolerance = 1e-4;
// The same without the tolerance's factor of ten: where k·k̂ is nearer to 0, rounding decides its sign.
constexpr double sign_rounding = 1e-5;  // over the gap
// Below this gap k follows k̂ only in part (docs/passes.md, "Direction").
constexpr double certain_gap = 0.01;
// Ten rounds multiply errors of 1e-6 turns by the number of rounds and neighbours; where |d| is near ½ the
// wrap may differ.
constexpr double phase_tolerance = 1e-3;  // rad
constexpr double phase_fraction = 0.999;  // of wrinkled vertices
constexpr int phase_rounds = 10;
// One step of closing a loop is a few operations on numbers below π; the phase of a solved wave is only
// stored.
constexpr double lead_tolerance = 1e-5;  // rad

double wrapped_difference(double a, double b) {
  return std::remainder(a - b, 2 * reference::pi);
}

// The condition of a normal of the posed triangles: |Σ areas| over Σ |e||e|.
double normal_certainty(const reference::Topology& topology, const Eigen::Matrix3Xd& positions,
                        Index vertex) {
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  double size = 0;
  for (const Corner& corner : reference::row(topology.corners, vertex)) {
    const Eigen::Vector3d p = positions.col(corner.second) - positions.col(vertex);
    const Eigen::Vector3d q = positions.col(corner.third) - positions.col(vertex);
    area += p.cross(q);
    size += p.norm() * q.norm();
  }
  return size > 0 ? area.norm() / size : 0;
}

// Whether with other rounding errors the status may be another, or the phase that of a solved wave. `q`: the
// direction of that, of any length, in the rest frame; 0 without one.
bool status_hangs_on_rounding(const reference::CrushResult& vertex, const reference::CrushState& previous,
                              double dead_zone, const Eigen::Vector2d& q) {
  const double s = 1 - vertex.r;
  const auto turned = [&](const Eigen::Vector2d& k) {
    return std::abs(std::abs(k.dot(q)) - std::sqrt(0.5) * q.norm());
  };
  if (turned(vertex.direction) * vertex.gap < sign_rounding * q.norm() ||
      turned(previous.direction) < sign_rounding * q.norm())
    return true;
  return std::abs(s - dead_zone) < r_tolerance || std::abs(s - dead_zone / 2) < r_tolerance ||
         std::abs(vertex.gap - certain_gap) < r_tolerance;
}

}  // namespace

WaveComparison::WaveComparison(LoadedScene& scene, ReferenceScene& reference, Stepper& stepper,
                               const std::string& shader_folder)
    : scene_(scene),
      reference_(reference),
      stepper_(stepper),
      chain_(reference),
      scratch_relax_(shader_folder),
      skin_(skin_tolerance, "of the bounding box"),
      frame_(frame_tolerance, "of a unit vector"),
      r_(r_tolerance, ""),
      height_(height_tolerance, "of W"),
      easing_(easing_tolerance, "of W"),
      weight_(weight_tolerance, ""),
      wave_vector_(wave_vector_tolerance, "times the gap"),
      status_(0, "of 1"),
      relax_(phase_tolerance, "rad", phase_fraction),
      ten_rounds_(phase_tolerance, "rad", phase_fraction),
      lead_(lead_tolerance, "rad"),
      begun_(lead_tolerance, "rad") {}

void WaveComparison::before_step(int step, bool looking) {
  pose_ = scene_.pose(step);
  looking_ = looking;
  share_ = scene_.lead_at(step);
  if (looking_) before_ = last_ = read_snapshot(stepper_.surface());
}

void WaveComparison::after_step(int step) {
  if (scene_.remembers_at(step)) remembered_ = read_snapshot(stepper_.surface());
  std::vector<Eigen::Vector2d> directions;
  for (const glm::vec4& state : stepper_.surface().states.read<glm::vec4>())
    directions.push_back(Eigen::Vector2f(state.x, state.y).cast<double>());
  if (scene_.has_bias_a_frame()) reference_.take_bias();
  chain_.step(step, pose_, stepper_.crush_runs_at(step), directions);
}

void WaveComparison::observe(Stepper::Stage stage) {
  if (!looking_) return;
  const WaveSnapshot now = read_snapshot(stepper_.surface());
  switch (stage) {
    case Stepper::Stage::posed:
      compare_skin(now);
      break;
    case Stepper::Stage::crushed:
      if (scene_.has_bias_a_frame()) reference_.take_bias();
      compare_crush(now);
      break;
    case Stepper::Stage::begun:
      if (share_ > 0) compare_lead(last_, now, Status::fresh, 1);
      crushed_ = now;
      compare_ten_rounds();
      break;
    case Stepper::Stage::relaxed:
      compare_relax(crushed_, now, reference_.relax, relax_);
      break;
    case Stepper::Stage::led:
      compare_lead(last_, now, Status::set, share_);
      break;
  }
  last_ = now;
}

void WaveComparison::compare_skin(const WaveSnapshot& gpu) {
  const Eigen::Matrix3Xd positions = reference_.positions(pose_);
  const double box = (positions.rowwise().maxCoeff() - positions.rowwise().minCoeff()).norm();
  const reference::Frames frames = reference_.frames(pose_, gpu.positions);
  for (Index v = 0; v < positions.cols(); ++v) {
    skin_.add((positions.col(v) - gpu.positions.col(v)).norm() / std::max(box, 1e-30));
    if (normal_certainty(reference_.topology, gpu.positions, v) < 1e-2) continue;
    frame_.add((frames.normal.col(v) - gpu.frames.normal.col(v)).norm());
    // The condition of the tangent: the tangential share of its edge.
    const Eigen::Vector3d edge =
        gpu.positions.col(reference_.tangent_neighbour[static_cast<std::size_t>(v)]) - gpu.positions.col(v);
    const double part =
        edge.norm() > 0 ? (edge - edge.dot(frames.normal.col(v)) * frames.normal.col(v)).norm() / edge.norm()
                        : 0;
    if (part > 1e-2) frame_.add((frames.tangent.col(v) - gpu.frames.tangent.col(v)).norm());
  }
}

void WaveComparison::compare_crush(const WaveSnapshot& gpu) {
  const auto expected = reference::crush(
      reference_.topology, reference_.rest_frames, gpu.positions, gpu.frames, reference_.wavelength,
      reference_.mask, reference_.crush,
      scene_.has_bias_a_frame() ? reference_.first_states(gpu.frames) : before_.states, reference_.bias);
  for (std::size_t v = 0; v < expected.size(); ++v) {
    const auto& e = expected[v];
    const auto i = static_cast<Index>(v);
    const double W = reference_.wavelength[i];
    r_.add(std::abs(1 - gpu.compression[i] - e.r) / std::max(1.0, e.r));
    (1 - e.r > reference_.crush.dead_zone ? height_ : easing_).add(std::abs(gpu.heights[i] - e.height) / W);
    weight_.add(std::abs(gpu.weights[i] - e.weight));
    const bool solved = !reference_.bias.phase.empty() && reference_.bias.phase[v];
    const Eigen::Vector2d q =
        solved ? Eigen::Vector2d(reference_.rest_frames.basis(i).transpose() * reference_.bias.p.col(i))
               : Eigen::Vector2d(0, 0);
    if (!status_hangs_on_rounding(e, before_.states[v], reference_.crush.dead_zone, q)) {
      status_.add(gpu.states[v].status == e.status ? 0 : 1);
      // Only a wave that comes back as solved gets a phase here.
      const bool turned = e.phase && e.direction.dot(gpu.states[v].direction) < 0;
      if (!scene_.has_bias_a_frame())
        begun_.add(std::abs(wrapped_difference(turned ? -gpu.phases[i] : gpu.phases[i],
                                               e.phase.value_or(before_.phases[i]))));
    }
    if (e.direction.norm() == 0 || gpu.states[v].direction.norm() == 0) continue;
    const Eigen::Vector2d own = gpu.wavenumbers.col(i) * W, kept = before_.states[v].direction;
    // The sign is arbitrary when a direction is first set. Later waves jump if it is wrong; either sign is
    // right only where k·k̂ is 0 up to rounding, and where k̂ has only a partial weight there are then two
    // valid k.
    const bool either = kept.norm() == 0 || std::abs(kept.dot(e.minimum)) * e.gap < sign_rounding;
    if (either && kept.norm() > 0 && e.gap < certain_gap) continue;
    double error = (own - e.wave_vector).norm();
    if (either) error = std::min(error, (own + e.wave_vector).norm());
    wave_vector_.add(e.gap * error / std::max(1.0, e.wave_vector.norm()));
  }
}

void WaveComparison::compare_relax(const WaveSnapshot& before, const WaveSnapshot& after,
                                   const reference::RelaxSettings& settings, Tally& tally) {
  reference::WaveField field = before.field();
  reference::relax(reference_.topology, field, settings);
  for (Index v = 0; v < field.phases.size(); ++v) {
    if (field.status[static_cast<std::size_t>(v)] == Status::set && field.weights[v] > 0) {
      tally.add(std::abs(wrapped_difference(field.phases[v], after.phases[v])));
    }
  }
}

// Ten rounds, independent of the scene's own number, on a copy of the phases.
void WaveComparison::compare_ten_rounds() {
  auto& surface = stepper_.surface();
  const auto phases = surface.phases.read<glm::vec2>();
  std::uint32_t fresh = 0;
  surface.counter.read(&fresh, sizeof fresh);
  auto options = relax_options(scene_.settings.relax);
  options.rounds = phase_rounds;
  scratch_relax_.run(surface, options);
  reference::RelaxSettings settings = reference_.relax;
  settings.descent_rounds = phase_rounds;
  compare_relax(crushed_, read_snapshot(surface), settings, ten_rounds_);
  surface.phases.write(phases);
  surface.counter.write(&fresh, sizeof fresh);
}

void WaveComparison::compare_lead(const WaveSnapshot& before, const WaveSnapshot& after, Status which,
                                  double share) {
  WaveSnapshot expected = before;
  reference::lead(expected.phases, expected.states, remembered_.phases, remembered_.states, which, share);
  for (Index v = 0; v < expected.phases.size(); ++v) {
    const auto i = static_cast<std::size_t>(v);
    if (expected.states[i].status == Status::idle) continue;
    lead_.add(expected.states[i].status == after.states[i].status
                  ? std::abs(wrapped_difference(expected.phases[v], after.phases[v]))
                  : INFINITY);
  }
}

double WaveComparison::chain_phase_difference(const WaveSnapshot& gpu) const {
  const WaveSnapshot& chain = chain_.now();
  double squares = 0, count = 0;
  for (Index v = 0; v < chain.phases.size(); ++v) {
    const auto i = static_cast<std::size_t>(v);
    if (chain.states[i].status != Status::set || gpu.states[i].status != Status::set ||
        !(chain.weights[v] > 0))
      continue;
    // A direction with the opposite sign, and the phase with the opposite sign, are the same wave.
    const double sign = chain.states[i].direction.dot(gpu.states[i].direction) < 0 ? -1 : 1;
    const double difference = wrapped_difference(sign * gpu.phases[v], chain.phases[v]);
    squares += difference * difference;
    count += 1;
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

void WaveComparison::report(std::map<std::string, PassComparison>& passes) const {
  passes["skin"] = skin_.comparison();
  passes["skin.frame"] = frame_.comparison();
  passes["crush"] = r_.comparison();
  passes["crush.r"] = r_.comparison();
  passes["crush.height"] = height_.comparison();
  passes["crush.easing"] = easing_.comparison();
  passes["crush.weight"] = weight_.comparison();
  passes["crush.wave_vector"] = wave_vector_.comparison();
  passes["crush.status"] = status_.comparison();
  passes["relax"] = relax_.comparison();
  passes["relax.ten_rounds"] = ten_rounds_.comparison();
  if (lead_.count() > 0) passes["relax.lead"] = lead_.comparison();
  if (begun_.count() > 0) passes["crush.phase"] = begun_.comparison();
}

}  // namespace plisse::pipeline
