#include "wrinkle/field.h"

#include <algorithm>
#include <chrono>
#include <memory>

#include "wrinkle/start.h"

namespace plisse::wrinkle {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

bool flat(const Waves& waves) {
  return waves.amplitude.size() == 0 || !(waves.amplitude.maxCoeff() > 0);
}

// The best of the standard start and, only where that ends without waves, of others.
Solution solve_from_starts(const Problem& problem, const FieldOptions& options) {
  Solution best = solve(problem, initial_waves(problem, options.frequency), options.solve);
  if (!flat(best.waves)) return best;
  for (const double factor : {0.7, 1.4}) {
    Solution other = solve(problem, initial_waves(problem, factor * options.frequency), options.solve);
    if (other.energy < best.energy) best = std::move(other);
  }
  return best;
}

// Vertices of live faces that have no amplitude at any corner.
std::vector<bool> dead_vertices(const Problem& problem, const Waves& waves) {
  std::vector<bool> dead(problem.pinned().size(), false);
  for (std::size_t f = 0; f < problem.complex().live.size(); ++f) {
    const shell::Face& t = problem.topology().faces[f];
    if (!problem.complex().live[f]) continue;
    if (waves.amplitude[t[0]] > 0 || waves.amplitude[t[1]] > 0 || waves.amplitude[t[2]] > 0) continue;
    for (const std::uint32_t v : t) dead[v] = true;
  }
  return dead;
}

}  // namespace

Field solve_field(const shell::Topology& topology, const std::vector<FaceForms>& forms, const Model& model,
                  const std::vector<bool>& wrinkle_free, const std::vector<bool>& clamped,
                  const FieldOptions& options) {
  const auto begin = Clock::now();
  auto problem = std::make_unique<Problem>(topology, forms, model, wrinkle_free, clamped);
  Field field;
  field.real = solve_from_starts(*problem, options);
  field.released.assign(topology.faces.size(), false);
  if (const auto dead = dead_vertices(*problem, field.real.waves);
      !flat(field.real.waves) && std::find(dead.begin(), dead.end(), true) != dead.end()) {
    std::vector<bool> pinned = dead;
    for (std::size_t v = 0; v < clamped.size(); ++v) pinned[v] = dead[v] || clamped[v];
    auto released = std::make_unique<Problem>(topology, forms, model, wrinkle_free, pinned);
    Solution other = solve_from_starts(*released, options);
    if (other.energy < field.real.energy) {
      for (std::size_t f = 0; f < field.released.size(); ++f)
        field.released[f] = problem->complex().live[f] && !released->complex().live[f];
      field.real = std::move(other);
      problem = std::move(released);
    }
  }
  field.solve_s = since(begin);
  const auto phase_begin = Clock::now();
  SolveOptions fixed = options.solve;
  fixed.fixed_periods = true;
  field.whole = field.real.waves.period.size() == 0
                    ? field.real
                    : solve(*problem, with_whole_periods(*problem, field.real.waves), fixed);
  field.one_form = problem->one_form(field.whole.waves);
  field.phase = corner_phases(*problem, field.whole.waves);
  field.phase_residual = phase_residual(*problem, field.real.waves, field.whole.waves);
  field.waves = wave_count(*problem, field.whole.waves);
  field.phase_s = since(phase_begin);
  return field;
}

}  // namespace plisse::wrinkle
