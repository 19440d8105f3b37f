#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/log.h"
#include "benchmark/effort.h"
#include "benchmark/plain_cpp.h"
#include "benchmark/sections.h"

namespace plisse::benchmark {
namespace {

constexpr float dead_zone = 0.005F, epsilon = 13.2F;
constexpr int rounds = 10;

// Agreement wanted: single precision and drivers' own square roots leave 1e-5 (see `plisse verify`); a wrong
// formula is off by far more than 1e-3.
constexpr float tolerance = 1e-3F;
// Where a misfit is next to half a turn the last bit decides to which side it is wrapped.
constexpr double phases_within = 0.999;

// Crush and a round of relax by both, from the same state.
bool agree(Rig& rig, const std::string& name) {
  PlainSurface plain(rig.surface());
  rig.crush();
  crush(plain, dead_zone, true);
  PlainSurface gpu(rig.surface());
  float worst = 0;
  for (std::size_t v = 0; v < plain.size(); ++v) {
    const float W = plain.constants[v].wavelength;
    const glm::vec2 k = plain.states[v].direction - gpu.states[v].direction;
    const glm::vec3 wavenumber = (plain.world_wavenumbers[v] - gpu.world_wavenumbers[v]) * W;
    // Directions are as certain as the gap g between the stretches.
    const float certainty = std::min(plain.states[v].certainty / 0.01F, 1.0F);
    for (float error : {std::abs(plain.states[v].compression - gpu.states[v].compression),
                        std::abs(plain.waves[v].height - gpu.waves[v].height) / W, certainty * glm::length(k),
                        certainty * glm::length(wavenumber)}) {
      worst = std::max(worst, std::isfinite(error) ? error : INFINITY);
    }
  }
  rig.relax(1, true);  // phases for those that began to wave
  plain = PlainSurface(rig.surface());
  rig.relax(1, false);
  descend(plain, epsilon, true);
  gpu = PlainSurface(rig.surface());
  std::size_t within = 0;
  for (std::size_t v = 0; v < plain.size(); ++v) {
    const float error = std::remainder(plain.phases[v].phase - gpu.phases[v].phase, glm::two_pi<float>());
    within += std::abs(error) <= tolerance ? 1 : 0;
  }
  const double share = static_cast<double>(within) / static_cast<double>(plain.size());
  const bool fine = worst <= tolerance && share >= phases_within;
  if (!fine) {
    log::warn(fmt::format(
        "{}: plain C++ and GPU disagree: crush by up to {:.2g}, phases of {:.2f} % of the vertices", name,
        worst, 100 * (1 - share)));
  }
  return fine;
}

}  // namespace

void measure_plain_cpp(Report& report, const Effort& effort) {
  Table table{"Crush and relax against plain C++",
              "Single precision, the compiler's -O3 for any x86-64; the results agree to 1e-3 with the "
              "GPU's, which this run "
              "checked. CPU time against one thread is like with like: the work itself. By the wall clock a "
              "software renderer, "
              "which takes all cores, is to be held against all cores.",
              {"model", "vertices", "pass", "by", "CPU ns per vertex", "wall ns per vertex",
               "GPU / this, CPU", "GPU / this, wall"},
              {}};
  for (const Subject& subject : {scene_subject("model_b", effort), grid_subject(effort)}) {
    const gpu::Context context;
    const Clock clock = fair_clock(context.info());
    Rig rig(subject, context.info().software);
    rig.skin();
    report.results_agree = agree(rig, subject.name) && report.results_agree;
    rig.step_to_middle();
    report.results_agree = agree(rig, subject.name) && report.results_agree;
    PlainSurface plain(rig.surface());

    const std::vector<Case> cases{
        {"crush",
         [&] {
           rig.crush();
           finish();
         }},
        {"crush", [&] { crush(plain, dead_zone, false); }},
        {"crush", [&] { crush(plain, dead_zone, true); }},
        {"relax, a round",
         [&] {
           rig.relax(rounds, false);
           finish();
         }},
        {"relax, a round",
         [&] {
           for (int i = 0; i < rounds; ++i) descend(plain, epsilon, false);
         }},
        {"relax, a round",
         [&] {
           for (int i = 0; i < rounds; ++i) descend(plain, epsilon, true);
         }},
    };
    const auto samples = take_turns(cases, effort);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const double share = 1e9 / subject.vertices() / (i < 3 ? 1 : rounds);
      const Samples& gpu = samples[i < 3 ? 0 : 3];
      const char* by[] = {"shader", "C++, one thread", "C++, all cores"};
      const bool ours = i % 3 == 0;
      table.rows.push_back({subject.name, Cell(subject.vertices(), 0), cases[i].name, by[i % 3],
                            Cell(samples[i].of(Clock::cpu).scaled(share), 0),
                            Cell(samples[i].of(Clock::wall).scaled(share), 0),
                            ours ? Cell("") : Cell(ratio(gpu, samples[i], Clock::cpu), 2),
                            ours ? Cell("") : Cell(ratio(gpu, samples[i], Clock::wall), 2)});
    }
    report.targets.push_back(
        {fmt::format("crush / plain C++, {}", subject.name), 1.5, ratio(samples[0], samples[1], clock)});
    report.targets.push_back(
        {fmt::format("relax / plain C++, {}", subject.name), 2, ratio(samples[3], samples[4], clock)});
  }
  report.tables.push_back(table);
}

}  // namespace plisse::benchmark
