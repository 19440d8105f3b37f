// Base surfaces and wrinkle fields that are solved once: find_equilibrium and solve_field, behind a cache.
#pragma once

#include "cloth/solved_cache.h"
#include "shell/newton.h"
#include "wrinkle/field.h"

namespace plisse::cloth {

// What a run took from the cache.
struct Reuse {
  int answers = 0;
  double saved_s = 0;  // what they took to find, less what it took to look them up
};

// As shell::find_equilibrium, which runs where the answer is not there yet. What did not converge, or took
// less than two thousandths of a second, is not kept.
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
