// Comparison of methods: the passes alone, the passes with a solved field, the field as geometry, and a shell
// that buckles by itself, all measured by `plisse measure`: the waves on their geometry.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/eigen_glm.h"
#include "base/log.h"
#include "bench/film.h"
#include "bench/solved.h"
#include "bench/suite.h"
#include "cloth/drape_examples.h"
#include "pipeline/displace.h"
#include "pipeline/look.h"
#include "pipeline/stepper.h"

namespace plisse::bench {
namespace {

const std::string example = "stretched-sheet";

struct Outcome {
  std::string label;
  double seconds = 0;  // to the first picture, wall clock
  double wavelength = 0, amplitude = 0;
};

double wavelength_of(const MeshSpectrum& spectrum) {
  return spectrum.waves.empty() ? 0 : spectrum.waves.front().wavelength;
}
double amplitude_of(const MeshSpectrum& spectrum) {
  return spectrum.waves.empty() ? 0 : spectrum.waves.front().amplitude;
}

class Methods {
 public:
  Methods(const Setup& setup, SuiteReport& report)
      : setup_(setup),
        report_(report),
        context_(setup.device),
        finest_(solve(setup, example, setup.pick(200, 2000, 4000))),
        solved_(solve(setup, example, coarse(setup))) {
    base_ = points_to_glm(finest_.base.surface.positions);
    base_triangles_ = corners(finest_.base.surface.topology.faces);
  }

  void measure() {
    truth_ = drawn("truth", still(finest_, config::FieldUse::direct), 0);
    passes_alone();
    const double solving = solved_.base_s + solved_.field_s;
    outcomes_.push_back(drawn("passes, field as bias", still(solved_, config::FieldUse::bias), solving));
    outcomes_.push_back(drawn("field drawn directly", still(solved_, config::FieldUse::direct), solving));
    outcomes_.push_back(drawn("field as geometry", still(solved_, config::FieldUse::direct), solving, true));
    buckled();
    write_rows();
  }

  std::string truth_text() const {
    return fmt::format("the field on {} vertices: waves of {:.1f} mm, {:.3f} mm high", finest_.vertices(),
                       1000 * truth_.wavelength, 1000 * truth_.amplitude);
  }
  std::size_t vertices() const { return solved_.vertices(); }

 private:
  static int coarse(const Setup& setup) { return setup.pick(150, 500, 500); }
  config::SceneSettings still(const Solved& solved, config::FieldUse use) const {
    return still_life(solved.base_file, solved.field_file, use, width(), height());
  }
  int width() const { return setup_.pick(64, 640, 1280); }
  int height() const { return setup_.pick(52, 512, 1024); }

  // Steps a scene to its last frame, draws it and measures its waves as geometry.
  Outcome drawn(const std::string& label, const config::SceneSettings& settings, double seconds,
                bool as_geometry = false) {
    pipeline::LoadedScene scene(settings);
    gpu::StageTimer timer(context_.info().software);
    pipeline::Stepper stepper(scene, timer, "");
    const int frame = scene.animation.timeline().frame_count;
    stepper.advance_to(scene.step_of_frame(frame));
    const gpu::Target target(width(), height(), 4, gpu::Target::Format::srgb8);
    const pipeline::Displacement displacement(scene, subdivide(scene.surface(), 1 << setup_.pick(1, 3, 3)));
    passes::RenderPass pass(pipeline::look_of(scene), scene.profile, pipeline::draw_parts(scene),
                            pipeline::texture_levels(scene), "");
    const Sample began = now();
    pass.draw(stepper.surface(), scene.view(frame), target, context_.info().software);
    finish();
    if (as_geometry) displacement.at(stepper.surface());
    seconds += (now() - began).wall_s;
    if (!as_geometry)
      setup_.save(report_, fmt::format("method_{}", report_.pictures.size()),
                  {width(), height(), target.read_rgba8()}, label);

    const DisplacedSurface moved = displacement.at(stepper.surface());
    std::vector<glm::dvec3> positions;
    for (const glm::dvec3& x : moved.positions) positions.push_back(displacement.metres(x));
    std::vector<std::uint32_t> triangles;
    for (const std::uint32_t v : displacement.mesh().triangles)
      triangles.push_back(displacement.mesh().vertices[v].position);
    return measured(label, seconds, positions, triangles);
  }

  Outcome measured(const std::string& label, double seconds, const std::vector<glm::dvec3>& positions,
                   const std::vector<std::uint32_t>& triangles) const {
    const MeshSpectrum spectrum =
        measure_waves(height_over_base(positions, triangles, base_, base_triangles_));
    return {label, seconds, wavelength_of(spectrum), amplitude_of(spectrum)};
  }

  // From the flat cloth to the base surface in two frames: the result of an animation without a solved field.
  void passes_alone() {
    const cloth::DrapeScene scene = cloth::drape_example(example, coarse(setup_));
    cloth::DrapeFrame frame;
    frame.equilibrium.converged = true;
    const auto folder = setup_.folder / "solved";
    cloth::write_base(folder / "pull_0001.ply", scene, frame, scene.start);
    cloth::write_base(folder / "pull_0002.ply", scene, frame, solved_.base.surface.positions);
    config::SceneSettings settings =
        still_life(folder / "pull_####.ply", "", config::FieldUse::bias, width(), height());
    outcomes_.push_back(drawn("passes alone", settings, solved_.base_s));
  }

  // St. Venant-Kirchhoff: no tension field, so the mesh itself must resolve the waves.
  void buckled() {
    cloth::DrapeScene scene = cloth::drape_example(example, setup_.pick(150, 2000, 8000));
    scene.stretching = shell::Stretching::stvk;
    scene.bending = shell::Bending::midedge;
    scene.perturb = 0.1 * scene.material.thickness;
    const auto path = setup_.folder / "solved" / "stvk.ply";
    const cloth::DrapeReport drape = cloth::drape({scene, "", path, {}});
    const cloth::WrinkleScene base = cloth::read_base(path);
    outcomes_.push_back(measured(
        fmt::format("StVK shell, {} vertices{}", drape.vertices, drape.converged ? "" : ", not converged"),
        drape.wall_s, points_to_glm(base.surface.positions), corners(base.surface.topology.faces)));
  }

  void write_rows() {
    for (const bool wavelength : {true, false}) {
      for (const Outcome& outcome : outcomes_) {
        const double value = wavelength ? outcome.wavelength : outcome.amplitude,
                     truth = wavelength ? truth_.wavelength : truth_.amplitude;
        Row row{"method",
                example,
                outcome.label,
                "",
                {outcome.seconds, outcome.seconds, outcome.seconds},
                Clock::wall,
                "all up to the first picture"};
        row.error_of = wavelength ? "wavelength" : "amplitude";
        row.error = truth > 0 ? 100 * std::abs(value / truth - 1) : 0;
        row.error_unit = wavelength ? "%, of the wavelength" : "%, of the amplitude";
        row.truth = truth_text();
        report_.rows.push_back(row);
      }
    }
  }

  const Setup& setup_;
  SuiteReport& report_;
  gpu::Context context_;
  Solved finest_, solved_;
  std::vector<glm::dvec3> base_;
  std::vector<std::uint32_t> base_triangles_;
  Outcome truth_;
  std::vector<Outcome> outcomes_;
};

}  // namespace

SuiteReport measure_method(const Setup& setup) {
  SuiteReport report;
  report.name = "method";
  report.title = "Method: passes, solved fields, geometry, a buckling shell";
  Methods methods(setup, report);
  methods.measure();
  report.note = fmt::format(
      "The stretched sheet by every method, on {} vertices but where said. Each method's waves are measured "
      "on its geometry, "
      "over the finest base surface, by spectrum ('plisse measure'): wavelength and amplitude of the "
      "strongest. The truth is "
      "{}. Times are the wall clock's, once, solvers included. 100 % off in wavelength and amplitude: no "
      "waves at all. The passes alone take their "
      "wavelength from the mesh, since nobody told them one.",
      methods.vertices(), methods.truth_text());
  return report;
}

}  // namespace plisse::bench
