// Hard cases of base surfaces and wrinkle fields (Chen et al. 2021): small scenes at the limits of the
// allowed values.
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "base/error.h"
#include "bench/hard.h"
#include "cloth/drape.h"
#include "cloth/drape_examples.h"
#include "cloth/wrinkle.h"
#include "shell/carry.h"

namespace plisse::bench {
namespace {

constexpr int few = 80;  // vertices: a fraction of a second each

struct Solution {
  shell::Equilibrium equilibrium;
  std::string problem;  // "": finite, and either converged or with a reason
};

Solution drape_of(const cloth::DrapeScene& scene, const shell::Positions& start) {
  const shell::Shell shell = cloth::shell_of(scene);
  const shell::Conditions conditions = scene.conditions(1);
  shell::NewtonSettings settings = scene.newton;
  settings.max_iterations = 300;
  Solution solution{shell::find_equilibrium(shell, conditions, scene.loads, start, settings), ""};
  if (!solution.equilibrium.positions.allFinite()) solution.problem = "positions are not finite";
  if (!std::isfinite(solution.equilibrium.energy)) solution.problem = "the energy is not finite";
  if (!solution.equilibrium.converged && solution.equilibrium.reason.empty())
    solution.problem = "no reason given";
  return solution;
}

Verdict converges_or_says_why(const cloth::DrapeScene& scene, const shell::Positions& start) {
  const Solution solution = drape_of(scene, start);
  if (!solution.problem.empty()) return {false, solution.problem};
  return {true, fmt::format("{:.6g} J after {} steps ({})", solution.equilibrium.energy,
                            solution.equilibrium.iterations, solution.equilibrium.reason)};
}

Verdict material(double poisson, double thickness) {
  cloth::DrapeScene scene = cloth::drape_example("strip", few);
  scene.material.poisson = poisson;
  scene.material.thickness = thickness;
  const Solution solution = drape_of(scene, scene.start);
  if (!solution.problem.empty()) return {false, solution.problem};
  // Pulled by a tenth and free to contract: uniaxial tension, Y/2 e² a volume with the Green strain e = (1.1²
  // − 1)/2, whatever ν is.
  const double strain = (1.1 * 1.1 - 1) / 2, volume = 0.25 * 0.1 * thickness;
  const double wanted = scene.material.young / 2 * strain * strain * volume;
  return {solution.equilibrium.converged && std::abs(solution.equilibrium.energy / wanted - 1) < 1e-3,
          fmt::format("{:.6g} J, {:.6g} by hand", solution.equilibrium.energy, wanted)};
}

Verdict collapsed_start() {
  const cloth::DrapeScene scene = cloth::drape_example("strip", few);
  shell::Positions start = scene.start;
  start.row(1).setZero();  // all triangles without area
  return converges_or_says_why(scene, start);
}

Verdict inverted_start() {
  const cloth::DrapeScene scene = cloth::drape_example("strip", few);
  shell::Positions start = scene.start;
  start.row(1) *= -1;
  return converges_or_says_why(scene, start);
}

// No loads and no stretch: no energy, and the search ends at once.
Verdict all_slack() {
  cloth::DrapeScene scene = cloth::drape_example("strip", few);
  const shell::Positions rest = scene.rest;
  const auto pulled = scene.conditions;
  scene.conditions = [pulled](double) { return pulled(0); };
  const Solution solution = drape_of(scene, rest);
  if (!solution.problem.empty()) return {false, solution.problem};
  return {solution.equilibrium.converged && std::abs(solution.equilibrium.energy) < 1e-12,
          fmt::format("{:.1e} J after {} steps ({})", solution.equilibrium.energy,
                      solution.equilibrium.iterations, solution.equilibrium.reason)};
}

// A strip under gravity that is not held.
Verdict unheld() {
  cloth::DrapeScene scene = cloth::drape_example("strip", few);
  const auto vertices = static_cast<std::size_t>(scene.start.cols());
  scene.conditions = [vertices](double) { return shell::Conditions(vertices); };
  scene.material.density = 1000;
  scene.loads.gravity = {0, -9.81, 0};
  try {
    drape_of(scene, scene.start);
  } catch (const Error& error) {
    return {error.code == ExitCode::bad_input, error.what()};
  }
  return {false, "no error"};
}

Verdict scaled(double scale) {
  cloth::DrapeScene scene = cloth::drape_example("strip", few);
  scene.rest *= scale;
  const shell::Positions start = scale * scene.start;
  const auto held = scene.conditions;
  scene.conditions = [held, scale](double t) {
    shell::Conditions conditions = held(t);
    conditions.at *= scale;
    return conditions;
  };
  scene.material.thickness *= scale;
  scene.start = start;
  const Solution solution = drape_of(scene, start);
  if (!solution.problem.empty()) return {false, solution.problem};
  const double strain = (1.1 * 1.1 - 1) / 2, volume = 0.25 * 0.1 * 1e-4 * scale * scale * scale;
  const double wanted = 1e6 / 2 * strain * strain * volume;
  return {solution.equilibrium.converged && std::abs(solution.equilibrium.energy / wanted - 1) < 1e-3,
          fmt::format("{:.6g} J, {:.6g} by hand ({})", solution.equilibrium.energy, wanted,
                      solution.equilibrium.reason)};
}

// The error text of a scene after a change that makes it invalid.
Verdict refused(const std::function<void(cloth::DrapeScene&)>& spoil, const std::string& word) {
  cloth::DrapeScene scene = cloth::drape_example("strip", few);
  spoil(scene);
  try {
    drape_of(scene, scene.start);
  } catch (const Error& error) {
    const std::string text = error.what();
    return {error.code == ExitCode::bad_input && text.find(word) != std::string::npos, text};
  }
  return {false, "no error"};
}

// The energy has no step where cloth begins to wrinkle: λ₂ passes −νλ₁, not 0 (eq. 32).
Verdict onset_is_continuous() {
  const shell::Material material{1e6, 0.3, 1e-4, 0};
  const shell::StretchingLaw law{material, shell::Stretching::tension_field, 0};
  const auto density = [&](double wide, double narrow) {
    return shell::stretching_density(law, wide, narrow).value;
  };
  const double wide = 0.1, onset = -0.3 * wide;
  const double below = density(wide, onset - 1e-9), above = density(wide, onset + 1e-9),
               under = density(wide, -1e-9), over = density(wide, 1e-9), at_zero = density(wide, 0);
  // Branching at 0 would make it jump by the factor 1/(1 − ν²) there; a step of 1e-9 in λ₂ moves it by less
  // than 1e-16 of itself at a minimum, so what is left is rounding; beside 0 it moves it by some 1e-8.
  return {std::abs(below / above - 1) < 1e-12 && std::abs(under / over - 1) < 1e-6 && at_zero > above,
          fmt::format("ψ = {:.9g} and {:.9g} J/m² on both sides", below, above)};
}

// --- wrinkle fields

// A position that is not finite, on a base surface from another program.
Verdict nan_in_the_base() {
  cloth::WrinkleRequest request;
  request.scene = cloth::base_of(cloth::drape_example("stretched-sheet", few));
  request.scene.surface.positions(1, 7) = std::nan("");
  try {
    cloth::wrinkle_field(request);
  } catch (const Error& error) {
    return {error.code == ExitCode::bad_input, error.what()};
  }
  return {false, "no error"};
}

// Compression in both directions at once: outside the model, but it must not fail.
Verdict squeezed_both_ways() {
  cloth::DrapeScene scene = cloth::drape_example("stretched-sheet", 200);
  scene.solved = true;
  scene.start = 0.98 * scene.rest;
  cloth::WrinkleRequest request;
  request.scene = cloth::base_of(scene);
  request.options.solve.max_iterations = 300;
  const cloth::WrinkleReport report = cloth::wrinkle_field(request);
  return {
      std::isfinite(report.max_amplitude) && std::isfinite(report.field.whole.energy),
      fmt::format("amplitudes up to {:.3g} mm ({})", 1000 * report.max_amplitude, report.field.whole.reason)};
}

Verdict field_of(const cloth::DrapeScene& scene, bool waves_wanted) {
  cloth::WrinkleRequest request;
  request.scene = cloth::base_of(scene);
  request.options.solve.max_iterations = 300;
  const cloth::WrinkleReport report = cloth::wrinkle_field(request);  // throws where it is not finite
  const auto& solution = report.field.whole;
  if (!solution.converged && solution.reason.empty()) return {false, "not converged, and no reason given"};
  const bool some = report.max_amplitude > 0;
  return {some == waves_wanted,
          fmt::format("amplitudes up to {:.3g} mm, {:.4g} waves ({})", 1000 * report.max_amplitude,
                      report.field.waves, solution.reason)};
}

// A strip that is free to contract has no compression anywhere.
Verdict nothing_to_wrinkle() {
  return field_of(cloth::drape_example("strip", few), false);
}

Verdict thin_field() {
  cloth::DrapeScene scene = cloth::drape_example("stretched-sheet", 200);
  scene.material.thickness = 1e-6;
  return field_of(scene, true);
}

Verdict closed_surface() {
  return field_of(cloth::drape_example("disk-balloon", 200), true);
}

Verdict flat_rest() {
  cloth::DrapeScene scene = cloth::drape_example("stretched-sheet", 200);
  scene.solved = true;  // the flat sheet itself: I_b = I_u, II_b = 0
  const auto pulled = scene.conditions;
  scene.conditions = [pulled](double) { return pulled(0); };
  return field_of(scene, false);
}

}  // namespace

std::vector<HardCase> hard_shells() {
  const char* either = "converged, or a reason; nothing that is not finite";
  return {
      {"drape", "Poisson's ratio 0", "the energy by hand", false, [] { return material(0, 1e-4); }},
      {"drape", "Poisson's ratio .4999", "the energy by hand", false, [] { return material(0.4999, 1e-4); }},
      {"drape", "Poisson's ratio .5", "the energy by hand", false, [] { return material(0.5, 1e-4); }},
      {"drape", "a thickness of 1e-6 m", "the energy by hand", false, [] { return material(0.3, 1e-6); }},
      {"drape", "a start whose triangles have no area", either, false, collapsed_start},
      {"drape", "a start that is turned over", either, false, inverted_start},
      {"drape", "everything slack", "no energy, converged", false, all_slack},
      {"drape", "nothing is held, gravity pulls", "an error that says so", false, unheld},
      {"drape", "a rest triangle without area", "an error that names it", false,
       [] {
         return refused(
             [](cloth::DrapeScene& scene) {
               const shell::Face& face = scene.rest_faces[3];
               scene.rest.col(face[1]) = scene.rest.col(face[0]);
             },
             "rest triangle 3");
       }},
      {"drape", "a start that is not a number", "an error", false,
       [] { return refused([](cloth::DrapeScene& scene) { scene.start(2, 5) = std::nan(""); }, ""); }},
      {"drape", "three faces on one edge", "an error that names it", false,
       [] {
         return refused(
             [](cloth::DrapeScene& scene) {
               scene.faces.push_back(scene.faces.front());
               scene.rest_faces.push_back(scene.rest_faces.front());
             },
             "edge");
       }},
      {"drape", "where cloth begins to wrinkle", "an energy without a step", false, onset_is_continuous},
      {"drape", "1e-6 times the size", "the energy by hand", false, [] { return scaled(1e-6); }},
      {"drape", "1e6 times the size", "the energy by hand", false, [] { return scaled(1e6); }},
      {"wrinkle", "no compression anywhere", "no waves, no error", false, nothing_to_wrinkle},
      {"wrinkle", "a base surface that is its own rest shape", "no waves, no error", false, flat_rest},
      {"wrinkle", "a point of the base that is not a number", "an error", false, nan_in_the_base},
      {"wrinkle", "squeezed in both directions", "finite, converged or a reason", false, squeezed_both_ways},
      {"wrinkle", "a thickness of 1e-6 m", "waves, converged or a reason", false, thin_field},
      {"wrinkle", "a closed surface", "waves, converged or a reason", false, closed_surface}};
}

}  // namespace plisse::bench
