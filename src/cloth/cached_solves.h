// find_equilibrium and solve_field with a cache, so that base surfaces and wrinkle fields are solved only
// once.
#pragma once

#include "cloth/solved_cache.h"
#include "shell/newton.h"
#include "wrinkle/field.h"

namespace plisse::cloth {

// The results that a run took from the cache.
struct Reuse {
  int answers = 0;
  double saved_s = 0;  // the time of their solves, less the time to look them up
};

// As shell::find_equilibrium, which runs if the result is not in the cache. Results that did not converge, or
// took less than two milliseconds, are not stored.
shell::Equilibrium cached_equilibrium(const SolvedCache& cache, Reuse& reuse, const shell::Shell& shell,
                                      const shell::Conditions& conditions, const shell::Loads& loads,
                                      const shell::Positions& start,
                                      const shell::NewtonSettings& settings = {},
                                      const shell::NewtonProgress& progress = {});

// As wrinkle::solve_field, likewise.
wrinkle::Field cached_field(const SolvedCache& cache, Reuse& reuse, const shell::Topology& topology,
                            const std::vector<wrinkle::FaceForms>& forms, const wrinkle::Model& model,
                            const std::vector<bool>& wrinkle_free, const std::vector<bool>& clamped = {},
                            const wrinkle::FieldOptions& options = {});

}  // namespace plisse::cloth
