// find_equilibrium, solve_field and the follower with a cache, so that base surfaces and wrinkle fields are
// solved only once.
#pragma once

#include <functional>
#include <vector>

#include "cloth/solved_cache.h"
#include "shell/follow.h"
#include "shell/newton.h"
#include "wrinkle/field.h"

namespace plisse::cloth {

// The base surfaces of a pose's shells (follow_model.h), by the hash of these shells; `solve` runs if they
// are not in the cache. An empty result, of an interrupted solve, is not stored.
std::vector<shell::Followed> cached_bases(const SolvedCache& cache, Reuse& reuse, const Hash& shells,
                                          const shell::Positions& pose,
                                          const std::function<std::vector<shell::Followed>()>& solve);

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
