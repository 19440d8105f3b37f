// The mesh resolution that the solvers need: base surface and wrinkle field on meshes near the recommendation
// of `plisse size`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/log.h"
#include "bench/film.h"
#include "bench/solved.h"
#include "bench/suite.h"
#include "sizing/resolution.h"

namespace plisse::bench {
namespace {

const std::string example = "stretched-sheet";

// The number of vertices of a uniform mesh of this area with the fabric's edge length: equilateral triangles,
// half a vertex each.
double recommended_vertices(const cloth::WrinkleScene& scene) {
  double area = 0;
  for (const auto& face : scene.surface.rest) area += face.area;
  const double edge =
      sizing::resolution_law().resolution(scene.material.bending_stiffness() / scene.material.young);
  return area / (std::numbers::sqrt3 / 2 * edge * edge);
}

std::string times_text(double factor) {
  return factor < 1 ? fmt::format("1/{:g}×", 1 / factor) : fmt::format("{:g}×", factor);
}

struct Mesh {
  double factor = 1;
  Solved solved;
  Samples frame;
};

double apart(double value, double truth) {
  return truth > 0 ? 100 * std::abs(value / truth - 1) : 0;
}

}  // namespace

SuiteReport measure_mesh(const Setup& setup) {
  SuiteReport report;
  report.name = "mesh";
  report.title = "Mesh: how many vertices the solvers need";
  const double recommended =
      setup.effort == Effort::smoke ? 120 : recommended_vertices(solve(setup, example, 200).base);
  std::vector<double> factors = setup.pick<std::vector<double>>({0.5, 1}, {0.0625, 0.125, 0.25, 0.5, 1},
                                                                {0.0625, 0.125, 0.25, 0.5, 1, 2, 4});

  const gpu::Context context(setup.device);
  const Clock clock = fair_clock(context.info());
  std::vector<Mesh> meshes;
  for (const double factor : factors) {
    Mesh mesh{factor, solve(setup, example, static_cast<int>(std::lround(factor * recommended))), {}};
    const config::SceneSettings settings =
        still_life(mesh.solved.base_file, mesh.solved.field_file, config::FieldUse::direct,
                   setup.pick(64, 640, 1280), setup.pick(52, 512, 1024));
    Film film(settings, example, context.info().software);
    mesh.frame = take_turns({{"frame", [&] { film.draw(film.rig.surface()); }}}, setup.turns()).front();
    setup.save(
        report, fmt::format("mesh_{}", mesh.solved.vertices()), film.picture(),
        fmt::format("{} ({} vertices): {:.1f} waves, {:.3f} mm", times_text(factor), mesh.solved.vertices(),
                    mesh.solved.field.field.waves, 1000 * mesh.solved.field.max_amplitude));
    meshes.push_back(std::move(mesh));
  }

  const Solved& finest = meshes.back().solved;
  const std::string truth =
      fmt::format("the finest mesh, {} vertices: {:.1f} waves, {:.3f} mm", finest.vertices(),
                  finest.field.field.waves, 1000 * finest.field.max_amplitude);
  report.note = fmt::format(
      "The stretched sheet (25 × 10 cm, a tenth longer), solved on meshes of {} to {} times the {:.0f} "
      "vertices that 'plisse "
      "size' recommends for its fabric. Number and greatest height of the waves against the finest mesh; the "
      "published "
      "answer (Wang et al., as Chen et al. 2021 quote it) is 5 waves of .35 mm. Solvers ran once each, on "
      "all cores, by the wall clock.",
      times_text(factors.front()), times_text(factors.back()), recommended);
  for (const Mesh& mesh : meshes) {
    if (&mesh == &meshes.back()) continue;
    const Solved& solved = mesh.solved;
    const auto once = [](double seconds) { return Distribution{seconds, seconds, seconds}; };
    Row row{"mesh",
            example,
            "",
            times_text(mesh.factor),
            once(solved.base_s + solved.field_s),
            Clock::wall,
            "base surface and field"};
    row.truth = truth;
    row.error_of = "amplitude";
    row.error = apart(solved.field.max_amplitude, finest.field.max_amplitude);
    row.error_unit = "%, of the greatest amplitude";
    report.rows.push_back(row);
    row.error_of = "number of waves";
    row.error = apart(solved.field.field.waves, finest.field.field.waves);
    row.error_unit = "%, of the number of waves";
    report.rows.push_back(row);
    row.detail = true;
    for (const auto& [stage, seconds] :
         {std::pair{"base surface alone", solved.base_s}, {"field alone", solved.field_s}}) {
      row.seconds_of = stage;
      row.seconds = once(seconds);
      report.rows.push_back(row);
    }
    row.seconds_of = "a frame";
    row.seconds = mesh.frame.of(clock);
    row.clock = clock;
    report.rows.push_back(row);
  }
  return report;
}

}  // namespace plisse::bench
