#include "wrinkle/field.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "base/clock.h"
#include "wrinkle/local_law.h"
#include "wrinkle/local_waves.h"
#include "wrinkle/patches.h"
#include "wrinkle/singularities.h"
#include "wrinkle/start.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double near = 1e-4;  // SolveOptions::trust of a start that is all but the answer

bool flat(const Waves& waves) {
  return waves.amplitude.size() == 0 || !(waves.amplitude.maxCoeff() > 0);
}

Waves flat_waves(const Problem& problem) {
  const auto zeros = [](std::size_t count) { return VectorXd(VectorXd::Zero(static_cast<Index>(count))); };
  return {zeros(problem.pinned().size()), zeros(problem.complex().vertices),
          zeros(problem.complex().periods)};
}

// Vertices of live faces with amplitude 0 at all corners.
std::vector<bool> dead_vertices(const Problem& problem, const Waves& waves) {
  std::vector<bool> dead(problem.pinned().size(), false);
  for (std::size_t f = 0; f < problem.live().size(); ++f) {
    const shell::Face& t = problem.topology().faces[f];
    if (!problem.live()[f]) continue;
    if (waves.amplitude[t[0]] > 0 || waves.amplitude[t[1]] > 0 || waves.amplitude[t[2]] > 0) continue;
    for (const std::uint32_t v : t) dead[v] = true;
  }
  return dead;
}

// The search for the lowest field: one problem after the other on the same surface, each with its own
// released vertices, and the lowest solution so far.
class Search {
 public:
  Search(const shell::Topology& topology, const std::vector<FaceForms>& forms, const Model& model,
         const std::vector<bool>& wrinkle_free, const std::vector<bool>& clamped, const FieldOptions& options)
      : forms_(forms),
        wrinkle_free_(wrinkle_free),
        clamped_(clamped),
        options_(options),
        released_(topology.vertex_count, false),
        whole_(std::make_shared<const Problem>(topology, forms, model, wrinkle_free, clamped)),
        problem_(whole_) {
    clamped_.resize(topology.vertex_count, false);
    // The vertices that would have waves if each face were independent.
    const std::vector<LocalWaves>& local = problem_->own_waves();
    VectorXd wish = VectorXd::Zero(static_cast<Index>(topology.vertex_count));
    for (std::size_t f = 0; f < local.size(); ++f) {
      if (!problem_->live()[f]) continue;
      const bool wants = local[f].compression > local[f].critical(model, local[f].gradient.norm());
      for (const std::uint32_t v : topology.faces[f]) wish[v] += (wants ? 1 : -1) * forms[f].rest.area;
    }
    for (const double w : wish) wants_.push_back(w > 0);
  }

  const Problem& problem() const { return *problem_; }

  void start(Field& field) {
    if (problem_->size() == 0) {  // no face is compressed
      best_ = solve(*problem_, flat_waves(*problem_), options_.solve);
      return;
    }
    std::vector<double> frequencies{1};
    if (options_.all_starts) frequencies = {1, 0.5, std::numbers::sqrt2 / 2, std::numbers::sqrt2, 2};
    std::vector<Solution> ends;
    for (const double frequency : frequencies) {
      ends.push_back(run(*problem_, initial_waves(*problem_, frequency * options_.frequency), loosely()));
      const Solution& end = ends.back();
      field.starts.push_back(
          {frequency * options_.frequency, end.start_energy, end.energy, end.iterations, end.converged});
    }
    best_ = lowest_by_patch(std::move(ends));
    if (whole_->model().relaxed_integrability) opened();
  }

  void release() {
    constexpr int rounds = 4;  // of one or a few solves each; most fields need one or two
    for (int round = 0; round < rounds && !flat(best_.waves); ++round) {
      const std::vector<bool> dead = dead_vertices(*problem_, best_.waves);
      if (revived(dead)) continue;
      if (!whole_->model().relaxed_integrability || (!widened(dead) && !won_back())) break;
    }
  }

  // To the end, from a search that was loose.
  void polish() {
    SolveOptions options = options_.solve;
    options.trust = near;
    best_ = run(*problem_, best_.waves, options);
  }

  void finish(Field& field) {
    field.released.assign(forms_.size(), false);
    for (std::size_t f = 0; f < forms_.size(); ++f)
      field.released[f] = whole_->live()[f] && !problem_->live()[f];
    field.real = std::move(best_);
    field.trace = std::move(trace_);
    field.iterations = iterations_;
    field.factorisations = factorisations_;
    field.solves = solves_;
  }

 private:
  // A release must lower the energy by at least this share of the energy above the relaxed one.
  static constexpr double worth = 1e-5;

  // Minima are compared before they are polished: the last tenths of a step change no choice between them.
  SolveOptions loosely() const {
    SolveOptions result = options_.solve;
    result.kkt = std::max(1e-4, result.kkt);
    result.energy = std::max(1e-5, result.energy);
    return result;
  }
  // Of a changed field, with most of it as before. A try that shows no success in this many steps is given
  // up.
  SolveOptions brief() const {
    SolveOptions result = loosely();
    result.max_iterations = std::min(result.max_iterations, 60);
    result.trust = 0.1;
    result.target = best_.energy;
    return result;
  }

  Solution run(const Problem& problem, const Waves& start, const SolveOptions& options) {
    const double began = wall_seconds() - begin_;
    Solution solution = solve(problem, start, options);
    for (const SolveStep& step : solution.trace) {
      if (trace_.empty() || step.energy < trace_.back().energy)
        trace_.push_back({iterations_ + step.iteration, began + step.seconds, step.energy});
    }
    iterations_ += solution.iterations;
    factorisations_ += solution.factorisations;
    ++solves_;
    return solution;
  }

  bool less(const Solution& a) const {
    return a.energy < best_.energy - worth * (best_.energy - problem_->relaxed_energy());
  }

  // Patches are independent: each takes its best start, or stays flat.
  Solution lowest_by_patch(std::vector<Solution> ends) {
    Solution none;
    none.waves = flat_waves(*problem_);
    none.energy = problem_->energy(problem_->pack(none.waves)) + problem_->relaxed_energy();
    none.converged = true;
    none.reason = "stationary";
    Solution best = ends[0];
    const auto parts = patches(problem_->topology(), problem_->live());
    std::vector<VectorXd> energy;
    ends.push_back(none);
    for (const Solution& end : ends) energy.push_back(problem_->face_energies(problem_->pack(end.waves)));
    bool mixed = false;
    for (const auto& faces : parts) {
      std::size_t lowest = 0;
      std::vector<double> sums;
      for (const VectorXd& e : energy) {
        double sum = 0;
        for (const std::uint32_t f : faces) sum += e[f];
        sums.push_back(sum);
      }
      for (std::size_t i = 1; i < sums.size(); ++i)
        if (sums[i] < sums[lowest]) lowest = i;
      if (lowest == 0) continue;
      mixed = true;
      problem_->copy_patch(faces, ends[lowest].waves, best.waves);
    }
    if (!mixed) return best;
    return run(*problem_, best.waves, loosely());
  }

  // Waves for vertices with a = 0 that should have some, without a release.
  bool revived(const std::vector<bool>& dead) {
    bool any = false;
    for (std::size_t v = 0; v < dead.size(); ++v) any = any || (dead[v] && wants_[v]);
    if (!any) return false;
    Solution other = run(*problem_, continued_waves(*problem_, *problem_, best_.waves), brief());
    if (!less(other)) return false;
    best_ = std::move(other);
    return true;
  }

  // Releases one face at every vertex around which the waves turn: otherwise ω could not be closed, for
  // example on a closed surface, or on a disk with radial waves.
  bool opened() {
    const std::vector<int> index = double_index(forms_, whole_->topology(), whole_->live());
    std::vector<std::uint32_t> calmest(index.size(), shell::none);  // the least compressed face around each
    for (std::uint32_t f = 0; f < forms_.size(); ++f) {
      if (!whole_->live()[f]) continue;
      for (const std::uint32_t v : whole_->topology().faces[f]) {
        if (index[v] == 0 || !wants_[v]) continue;
        if (calmest[v] == shell::none ||
            principal_strain(forms_[f]).compression > principal_strain(forms_[calmest[v]]).compression)
          calmest[v] = f;
      }
    }
    std::vector<bool> released = released_;
    for (const std::uint32_t f : calmest) {
      if (f == shell::none) continue;
      for (const std::uint32_t v : whole_->topology().faces[f]) released[v] = true;
    }
    if (released == released_) return false;
    const auto problem = releasing(released);
    return taken(problem, run(*problem, initial_waves(*problem, options_.frequency), brief()), released);
  }

  std::shared_ptr<const Problem> releasing(const std::vector<bool>& released) const {
    std::vector<bool> pinned = clamped_;
    for (std::size_t v = 0; v < pinned.size(); ++v) pinned[v] = pinned[v] || released[v];
    return std::make_shared<const Problem>(whole_->topology(), forms_, whole_->model(), wrinkle_free_,
                                           pinned);
  }

  bool taken(std::shared_ptr<const Problem> problem, Solution other, const std::vector<bool>& released) {
    if (!less(other)) return false;
    best_ = std::move(other);
    problem_ = std::move(problem);
    released_ = released;
    return true;
  }

  bool take(const std::vector<bool>& released) {
    const auto problem = releasing(released);
    return taken(problem, run(*problem, continued_waves(*problem, *problem_, best_.waves), brief()),
                 released);
  }

  // Releases faces with a = 0.
  bool widened(const std::vector<bool>& dead) {
    if (std::find(dead.begin(), dead.end(), true) == dead.end()) return false;
    std::vector<bool> all = released_;
    for (std::size_t v = 0; v < all.size(); ++v) all[v] = all[v] || dead[v];
    return take(all);
  }

  // Makes released faces live again that should have waves and are beside some.
  bool won_back() {
    std::vector<bool> rest = released_;
    for (const shell::Face& t : whole_->topology().faces) {
      const bool beside = best_.waves.amplitude[t[0]] > 0 || best_.waves.amplitude[t[1]] > 0 ||
                          best_.waves.amplitude[t[2]] > 0;
      for (const std::uint32_t v : t) {
        if (beside && wants_[v]) rest[v] = false;
      }
    }
    return rest != released_ && take(rest);
  }

  const std::vector<FaceForms>& forms_;
  const std::vector<bool>& wrinkle_free_;
  std::vector<bool> clamped_;
  const FieldOptions& options_;
  std::vector<bool> released_, wants_;              // one a vertex
  std::shared_ptr<const Problem> whole_, problem_;  // without released faces; with the current ones
  Solution best_;
  std::vector<SolveStep> trace_;
  int iterations_ = 0, factorisations_ = 0, solves_ = 0;
  double begin_ = wall_seconds();
};

// A state that was not minimised.
Solution unsolved(const Problem& problem, Waves waves) {
  Solution solution;
  VectorXd first;
  const VectorXd x = problem.pack(waves);
  const double energy = problem.gradient(x, first);
  solution.kkt = kkt_residual(problem, x, energy, first);
  solution.start_energy = solution.energy = energy + problem.relaxed_energy();
  solution.trace = {{0, 0, solution.energy}};
  solution.converged = true;
  solution.reason = "a local law, not solved";
  solution.waves = std::move(waves);
  return solution;
}

void read_off(const Problem& problem, Field& field) {
  const Waves& waves = field.whole.waves;
  field.one_form = problem.one_form(waves);
  field.phase = corner_phases(problem, waves);
  field.phase_residual = phase_residual(problem, field.real.waves, waves);
  field.count =
      count_waves(problem.topology(), problem.forms(), problem.live(), waves.amplitude, field.one_form);
  field.waves = field.count.waves;
  field.above_tenth =
      count_waves(problem.topology(), problem.forms(), problem.live(), waves.amplitude, field.one_form, 0.1);
  field.wavelength = wavelength_at_highest(problem.topology(), problem.forms(), problem.live(),
                                           waves.amplitude, field.one_form);
}

Field by_local_law(const Problem& problem, const std::vector<bool>& clamped) {
  const double begin = wall_seconds();
  Field field;
  field.real = unsolved(problem, vandeparre_waves(problem, clamped));
  field.trace = field.real.trace;
  field.released.assign(problem.forms().size(), false);
  field.solve_s = wall_seconds() - begin;
  const double phase_begin = wall_seconds();
  field.whole = unsolved(problem, with_whole_periods(problem, field.real.waves));
  read_off(problem, field);
  field.phase_s = wall_seconds() - phase_begin;
  return field;
}

}  // namespace

Field solve_field(const shell::Topology& topology, const std::vector<FaceForms>& forms, const Model& model,
                  const std::vector<bool>& wrinkle_free, const std::vector<bool>& clamped,
                  const FieldOptions& options) {
  if (options.local_law) return by_local_law(Problem(topology, forms, model, wrinkle_free, clamped), clamped);
  const double begin = wall_seconds();
  Field field;
  Search search(topology, forms, model, wrinkle_free, clamped, options);
  search.start(field);
  search.release();
  search.polish();
  search.finish(field);
  field.solve_s = wall_seconds() - begin;
  const double phase_begin = wall_seconds();
  const Problem& problem = search.problem();
  SolveOptions fixed = options.solve;
  fixed.fixed_periods = true;
  fixed.trust = near;
  field.whole = field.real.waves.period.size() == 0
                    ? field.real
                    : solve(problem, with_whole_periods(problem, field.real.waves), fixed);
  if (field.real.waves.period.size() > 0) {
    field.iterations += field.whole.iterations;
    field.factorisations += field.whole.factorisations;
    ++field.solves;
  }
  read_off(problem, field);
  field.phase_s = wall_seconds() - phase_begin;
  return field;
}

}  // namespace plisse::wrinkle
