#include "wrinkle/sequence.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "base/clock.h"
#include "wrinkle/closed_form.h"
#include "wrinkle/patches.h"
#include "wrinkle/start.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
constexpr double turn = 2 * std::numbers::pi;

// Amplitudes that are 0 stay so by symmetry, the energy being even in them; where new waves may have become
// possible since the frame before, amplitudes start from this share of the faces' own ones.
constexpr double seed = 0.05;

// Frames.
constexpr int fresh_start_every = 6;

bool has_waves(const CoarseField& field, const shell::Face& t) {
  return field.amplitude[t[0]] > 0 || field.amplitude[t[1]] > 0 || field.amplitude[t[2]] > 0;
}

bool flat(const Eigen::VectorXd& amplitude) {
  return amplitude.size() == 0 || !(amplitude.maxCoeff() > 0);
}

Vector2d gradient(const FaceForms& forms, const std::array<double, 3>& phase) {
  return forms.rest.gradients * Eigen::Vector3d(phase[0], phase[1], phase[2]);
}

// Root mean square of the angle between two fields' a exp(iφ).
double phase_step(const shell::Topology& topology, const std::vector<FaceForms>& forms,
                  const CoarseField& before, const CoarseField& now) {
  double squares = 0, weights = 0;
  if (before.phase.empty()) return 0;
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = topology.faces[f][c];
      const double weight = forms[f].rest.area * before.amplitude[v] * now.amplitude[v];
      squares += weight * std::pow(std::remainder(now.phase[f][c] - before.phase[f][c], turn), 2);
      weights += weight;
    }
  }
  return weights > 0 ? std::sqrt(squares / weights) : 0;
}

Eigen::VectorXd one_form(const shell::Topology& topology, const CoarseField& field) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Index>(topology.edges.size()));
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    if (!has_waves(field, topology.faces[f])) continue;
    for (std::size_t side = 0; side < 3; ++side)
      result[side_edge(topology, f, side)] =
          side_sign(topology, f, side) * (field.phase[f][(side + 1) % 3] - field.phase[f][side]);
  }
  return result;
}

double smooth(double t) {
  return t * t * (3 - 2 * t);
}

}  // namespace

CoarseField cross_faded(const std::vector<shell::Face>& faces, const CoarseField& from, const CoarseField& to,
                        double share) {
  const bool later = share >= 0.5;
  const CoarseField &main = later ? to : from, &other = later ? from : to;
  const double small = later ? 1 - share : share;
  CoarseField result = main;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = faces[f][c];
      const double turn_to = other.phase[f][c] - main.phase[f][c];
      const auto turned = std::polar(1.0, turn_to);
      // Where a field has no amplitude its corners' phases need not agree, and the other one's count alone.
      const bool here = main.amplitude[v] > 0, there = other.amplitude[v] > 0;
      if (here && there) result.phase[f][c] += std::arg(1 - small + small * turned);
      if (there && !here) result.phase[f][c] += std::remainder(turn_to, turn);
      if (here || there)
        result.amplitude[v] = std::abs((1 - small) * main.amplitude[v] + small * other.amplitude[v] * turned);
    }
  }
  return result;
}

void align(const shell::Topology& topology, const std::vector<FaceForms>& forms, const CoarseField& reference,
           CoarseField& field) {
  if (reference.phase.empty()) return;
  std::vector<bool> waves;
  for (const shell::Face& t : topology.faces) waves.push_back(has_waves(field, t));
  for (const auto& patch : patches(topology, waves)) {
    const auto weight = [&](std::uint32_t f, std::size_t c) {
      const std::uint32_t v = topology.faces[f][c];
      return forms[f].rest.area * reference.amplitude[v] * field.amplitude[v];
    };
    double agreement = 0;
    for (const std::uint32_t f : patch)
      agreement += (weight(f, 0) + weight(f, 1) + weight(f, 2)) *
                   gradient(forms[f], reference.phase[f]).dot(gradient(forms[f], field.phase[f]));
    std::complex<double> overlap = 0;
    for (const std::uint32_t f : patch) {
      for (std::size_t c = 0; c < 3; ++c) {
        if (agreement < 0) field.phase[f][c] = -field.phase[f][c];
        overlap += std::polar(weight(f, c), reference.phase[f][c] - field.phase[f][c]);
      }
    }
    if (std::abs(overlap) == 0) continue;
    for (const std::uint32_t f : patch)
      for (double& phase : field.phase[f]) phase += std::arg(overlap);
  }
}

FieldSequence::FieldSequence(shell::Topology topology, const Model& model, std::vector<bool> clamped,
                             const SequenceOptions& options)
    : topology_(std::move(topology)), model_(model), clamped_(std::move(clamped)), options_(options) {}

// The field of the frame before on this frame's live faces, its periods kept. Faces that have just become
// live continue their neighbours' waves; patches without such neighbours start with their own waves.
Waves FieldSequence::carried(const Problem& problem, const CoarseField& before) const {
  const PhaseComplex& complex = problem.complex();
  const std::size_t faces = topology_.faces.size();
  std::vector<bool> fresh(faces, false);
  bool due = false;
  for (std::size_t f = 0; f < faces; ++f) {
    fresh[f] = complex.live[f] && !has_waves(before, topology_.faces[f]);
    for (const std::uint32_t v : topology_.faces[f])
      due = due || (complex.live[f] && !problem.pinned()[v] && !(before.amplitude[v] > 0));
  }
  Waves own;
  if (due) own = initial_waves(problem);
  std::vector<Vector2d> gradients(faces, Vector2d::Zero());
  std::vector<double> weights(faces, 0);
  const double most = before.amplitude.maxCoeff();
  for (std::size_t f = 0; f < faces; ++f) {
    if (!complex.live[f]) continue;
    const shell::Face& t = topology_.faces[f];
    const FaceForms& forms = problem.forms()[f];
    if (fresh[f]) {
      if (due) gradients[f] = forms.rest.gradients * complex.corner_phases(f, own.phase, own.period);
      weights[f] = 1e-6 * forms.rest.area;
    } else {
      const double a =
          (before.amplitude[t[0]] + before.amplitude[t[1]] + before.amplitude[t[2]]) / (3 * most);
      gradients[f] = gradient(forms, before.phase[f]);
      weights[f] = forms.rest.area * std::max(a * a, 1e-4);
    }
  }
  Waves waves = nearest_closed(problem, gradients, weights);
  const Eigen::VectorXd whole = turn * (waves.period / turn).array().round();
  if ((whole - waves.period).cwiseAbs().sum() > 1e-9)
    waves = nearest_closed(problem, gradients, weights, &whole);
  waves.period = whole;
  for (Index v = 0; v < waves.amplitude.size(); ++v) {
    if (problem.pinned()[static_cast<std::size_t>(v)]) continue;
    waves.amplitude[v] = before.amplitude[v];
    if (due) waves.amplitude[v] = std::max(waves.amplitude[v], seed * own.amplitude[v]);
  }
  return waves;
}

FieldSequence::State FieldSequence::state_of(const Problem& problem, const Waves& waves) const {
  const WaveCount count =
      count_waves(topology_, problem.forms(), problem.live(), waves.amplitude, problem.one_form(waves));
  // Around a loop they are whole numbers up to rounding.
  return {{waves.amplitude, corner_phases(problem, waves)},
          count.round ? std::round(count.waves) : count.waves};
}

Solution FieldSequence::solve_on(const Problem& problem, const Waves& start, bool fixed_periods,
                                 SequenceFrame& frame) const {
  SolveOptions options = options_.field.solve;
  options.fixed_periods = fixed_periods;
  Solution solution = solve(problem, start, options);
  frame.iterations += solution.iterations;
  if (!solution.converged && frame.converged) {
    frame.converged = false;
    frame.reason = solution.reason;
  }
  return solution;
}

// A field with other periods whose energy is low enough for a change: searched from the current field, and
// sometimes from an independent start, since there are many minima.
std::optional<Waves> FieldSequence::other_periods(const Problem& problem, const Solution& kept,
                                                  SequenceFrame& frame) {
  if (kept.waves.period.size() == 0) return std::nullopt;
  std::vector<Waves> starts{kept.waves};
  if (checks_++ % fresh_start_every == 0) starts.push_back(initial_waves(problem, options_.field.frequency));
  std::optional<Solution> best;
  double real_energy = kept.energy;
  for (const Waves& start : starts) {
    const Solution real = solve_on(problem, start, false, frame);
    real_energy = std::min(real_energy, real.energy);
    const Waves whole = with_whole_periods(problem, real.waves);
    if ((whole.period - kept.waves.period).cwiseAbs().maxCoeff() < 1) continue;
    Solution other = solve_on(problem, whole, true, frame);
    if (!flat(other.waves.amplitude) && (!best || other.energy < best->energy)) best = std::move(other);
  }
  if (!best) return std::nullopt;
  const double keeping = kept.energy - real_energy, changing = std::max(best->energy - real_energy, 0.0);
  if (!(keeping > options_.hysteresis * changing)) return std::nullopt;
  return best->waves;
}

std::optional<FieldSequence::State> FieldSequence::begun(const Problem& problem,
                                                         const std::vector<FaceForms>& forms,
                                                         const std::vector<bool>& wrinkle_free,
                                                         SequenceFrame& frame) const {
  const Field field = solve_field(topology_, forms, model_, wrinkle_free, clamped_, options_.field);
  frame.iterations += field.iterations;
  if (flat(field.whole.waves.amplitude)) return std::nullopt;
  // Faces that were released there are live here, as later frames may need waves on them.
  const Solution solution =
      solve_on(problem, carried(problem, {field.whole.waves.amplitude, field.phase}), true, frame);
  frame.energy = solution.energy;
  frame.kkt = solution.kkt;
  if (flat(solution.waves.amplitude)) return std::nullopt;
  return state_of(problem, solution.waves);
}

SequenceFrame FieldSequence::next(const std::vector<FaceForms>& forms,
                                  const std::vector<bool>& wrinkle_free) {
  const double began = wall_seconds();
  SequenceFrame frame;
  const Problem problem(topology_, forms, model_, wrinkle_free, clamped_);
  const auto go_on = [&](State& state) {
    const Solution solution = solve_on(problem, carried(problem, state.field), true, frame);
    State next = state_of(problem, solution.waves);
    align(topology_, forms, state.field, next.field);
    state = std::move(next);
    return solution;
  };
  frame.energy = problem.relaxed_energy();  // where nothing wrinkles
  frame.reason = "stationary";
  if (problem.size() == 0) {  // no face is compressed
    now_.reset();
    before_.reset();
  } else if (now_) {
    if (before_) {
      go_on(*before_);
      if (flat(before_->field.amplitude)) before_.reset();
    }
    const Solution kept = go_on(*now_);
    frame.energy = kept.energy;
    frame.kkt = kept.kkt;
    if (flat(kept.waves.amplitude)) {
      now_.reset();
      before_.reset();
    } else if (!before_ && faded_ >= options_.fade) {
      if (const auto other = other_periods(problem, kept, frame)) {
        before_ = std::move(now_);
        now_ = state_of(problem, *other);
        align(topology_, forms, before_->field, now_->field);
        frame.waves_before = before_->waves;
        faded_ = checks_ = 0;
        rises_ = false;
      }
    }
  } else if (auto state = begun(problem, forms, wrinkle_free, frame)) {
    now_ = std::move(state);
    if (!shown_.phase.empty()) {  // the first frame is not aligned
      frame.waves_before = 0;
      faded_ = 0;
      rises_ = true;
    } else {
      faded_ = options_.fade;
    }
  }

  if (now_) {
    frame.waves = now_->waves;
    frame.field = now_->field;
    if (faded_ < options_.fade && (before_ || rises_)) {
      frame.share = smooth(++faded_ / (options_.fade + 1.0));
      if (before_)
        frame.field = cross_faded(topology_.faces, before_->field, now_->field, frame.share);
      else
        frame.field.amplitude *= frame.share;
      if (faded_ == options_.fade) before_.reset();
    }
    rises_ = rises_ && faded_ < options_.fade;
    frame.phase_step = phase_step(topology_, forms, shown_, frame.field);
  } else {
    frame.field.amplitude = Eigen::VectorXd::Zero(static_cast<Index>(topology_.vertex_count));
    frame.field.phase.assign(topology_.faces.size(), {0, 0, 0});
  }
  frame.one_form = one_form(topology_, frame.field);
  shown_ = frame.field;
  frame.solve_s = wall_seconds() - began;
  return frame;
}

}  // namespace plisse::wrinkle
