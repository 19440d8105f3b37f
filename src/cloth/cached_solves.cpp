#include "cloth/cached_solves.h"

#include <variant>

#include "base/clock.h"
#include "cloth/cached_answer.h"

namespace plisse::cloth {
// Not in the nameless namespace: archives find these by their argument.

// --- what an equilibrium depends on, and what it is

void members(auto& a, Is<shell::Material> auto& value) {
  auto& [young, poisson, thickness, density] = value;
  a(young, poisson, thickness, density);
}
void members(auto& a, Is<shell::RestFace> auto& value) {
  auto& [edges, gradients, area] = value;
  a(edges, gradients, area);
}
// Edges, flaps and parts follow from the faces.
void members(auto& a, Is<shell::Topology> auto& value) {
  auto& [vertex_count, faces, edges, face_edges, flaps, component, component_count] = value;
  a(vertex_count, faces);
}
void members(auto& a, Is<shell::Shell> auto& value) {
  auto& [topology, rest, material, stretching, bending, residual, tension_limit, rest_forms] = value;
  a(topology, rest, material, stretching, bending, residual, tension_limit, rest_forms);
}
void members(auto& a, Is<shell::Conditions::Mirror> auto& value) {
  auto& [axis, at] = value;
  a(axis, at);
}
// Values where nothing is held are not used.
void members(auto& a, Is<shell::Conditions> auto& value) {
  auto& [held, at, mirrors] = value;
  a(held, shell::Positions(held.select(at, 0.0)), mirrors);
}
void members(auto& a, Is<shell::Body> auto& value) {
  a(value->tree().points(), value->tree().triangles());
}
template <typename Solid>
requires requires(const Solid& solid) {
  Solid::words;
}
void members(auto& a, const Solid& solid) {
  a(std::string(Solid::words.name));
  solid.visit_members(a);
}
void members(auto& a, Is<shell::Obstacle> auto& value) {
  std::visit([&](auto& body) { a(body); }, value);
}
void members(auto& a, Is<shell::Loads> auto& value) {
  value.visit_members(a);
}
void members(auto& a, Is<shell::NewtonSettings> auto& value) {
  auto& [max_iterations, tolerance, max_seconds] = value;
  a(max_iterations, tolerance, max_seconds);
}
void members(auto& a, Is<shell::NewtonStep> auto& value) {
  auto& [iteration, seconds, energy, gradient_inf, step, shift] = value;
  a(iteration, seconds, energy, gradient_inf, step, shift);
}
void members(auto& a, Is<shell::Equilibrium> auto& value) {
  auto& [positions, energy, friction, gradient_inf, force_scale, iterations, converged, reason, anchors,
         trace, assembly_s, factor_s, line_search_s, analysis_s, factor_nonzeros] = value;
  a(positions, energy, friction, gradient_inf, force_scale, iterations, converged, reason, anchors, trace,
    assembly_s, factor_s, line_search_s, analysis_s, factor_nonzeros);
}

void members(auto& a, Is<shell::Followed> auto& value) {
  auto& [base, moved_rms, moved_most, iterations, converged] = value;
  a(base, moved_rms, moved_most, iterations, converged);
}

// --- what a field depends on, and what it is

void members(auto& a, Is<wrinkle::FaceForms> auto& value) {
  auto& [rest, strain, second_form, noise, room] = value;
  a(rest, strain, second_form, noise, room);
}
void members(auto& a, Is<wrinkle::Model> auto& value) {
  auto& [material, v1, v2, curvature_factor, crest_compression, relaxed_integrability] = value;
  a(material, v1, v2, curvature_factor, crest_compression, relaxed_integrability);
}
void members(auto& a, Is<wrinkle::SolveOptions> auto& value) {
  auto& [max_iterations, kkt, energy, fixed_periods, trust, target] = value;
  a(max_iterations, kkt, energy, fixed_periods, trust, target);
}
void members(auto& a, Is<wrinkle::FieldOptions> auto& value) {
  auto& [solve, frequency, local_law, all_starts] = value;
  a(solve, frequency, local_law, all_starts);
}
void members(auto& a, Is<wrinkle::Waves> auto& value) {
  auto& [amplitude, phase, period] = value;
  a(amplitude, phase, period);
}
void members(auto& a, Is<wrinkle::SolveStep> auto& value) {
  auto& [iteration, seconds, energy] = value;
  a(iteration, seconds, energy);
}
void members(auto& a, Is<wrinkle::Solution> auto& value) {
  auto& [waves, start_energy, energy, kkt, iterations, assemblies, factorisations, converged, reason, trace] =
      value;
  a(waves, start_energy, energy, kkt, iterations, assemblies, factorisations, converged, reason, trace);
}
void members(auto& a, Is<wrinkle::FieldStart> auto& value) {
  auto& [frequency, start_energy, energy, iterations, converged] = value;
  a(frequency, start_energy, energy, iterations, converged);
}
void members(auto& a, Is<wrinkle::WaveCount> auto& value) {
  auto& [waves, round, length] = value;
  a(waves, round, length);
}
void members(auto& a, Is<wrinkle::Field> auto& value) {
  auto& [real, whole, one_form, phase, released, starts, trace, phase_residual, waves, count, above_tenth,
         wavelength, solves, iterations, factorisations, solve_s, phase_s] = value;
  a(real, whole, one_form, phase, released, starts, trace, phase_residual, waves, count, above_tenth,
    wavelength, solves, iterations, factorisations, solve_s, phase_s);
}

std::vector<shell::Followed> cached_bases(const SolvedCache& cache, Reuse& reuse, const Hash& shells,
                                          const shell::Positions& pose,
                                          const std::function<std::vector<shell::Followed>()>& solve) {
  if (!cache.on()) return solve();
  Hash question = shells;
  Hasher hasher(question);
  hasher(pose);
  if (auto known = answered<std::vector<shell::Followed>>(cache, question, reuse)) return std::move(*known);
  const double began = wall_seconds();
  std::vector<shell::Followed> found = solve();
  if (!found.empty()) keep(cache, question, found, wall_seconds() - began);
  return found;
}

shell::Equilibrium cached_equilibrium(const SolvedCache& cache, Reuse& reuse, const shell::Shell& shell,
                                      const shell::Conditions& conditions, const shell::Loads& loads,
                                      const shell::Positions& start, const shell::NewtonSettings& settings,
                                      const shell::NewtonProgress& progress) {
  if (!cache.on()) return shell::find_equilibrium(shell, conditions, loads, start, settings, progress);
  Hash question = SolvedCache::question("equilibrium");
  Hasher hasher(question);
  hasher(shell, conditions, loads, start, settings);
  if (auto known = answered<shell::Equilibrium>(cache, question, reuse)) return std::move(*known);
  const double began = wall_seconds();
  shell::Equilibrium found = shell::find_equilibrium(shell, conditions, loads, start, settings, progress);
  if (found.converged) keep(cache, question, found, wall_seconds() - began);
  return found;
}

wrinkle::Field cached_field(const SolvedCache& cache, Reuse& reuse, const shell::Topology& topology,
                            const std::vector<wrinkle::FaceForms>& forms, const wrinkle::Model& model,
                            const std::vector<bool>& wrinkle_free, const std::vector<bool>& clamped,
                            const wrinkle::FieldOptions& options) {
  if (!cache.on()) return wrinkle::solve_field(topology, forms, model, wrinkle_free, clamped, options);
  Hash question = SolvedCache::question("field");
  Hasher hasher(question);
  hasher(topology, forms, model, wrinkle_free, clamped, options);
  if (auto known = answered<wrinkle::Field>(cache, question, reuse)) return std::move(*known);
  const double began = wall_seconds();
  wrinkle::Field found = wrinkle::solve_field(topology, forms, model, wrinkle_free, clamped, options);
  if (found.real.converged && found.whole.converged) keep(cache, question, found, wall_seconds() - began);
  return found;
}

}  // namespace plisse::cloth
