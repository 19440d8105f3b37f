// Effect of single precision on the error, and of the implementation on the time, of each pass: shader and
// reference, both from the same state.
#include <fmt/format.h>

#include <cmath>

#include "base/colour.h"
#include "bench/film.h"
#include "bench/suite.h"
#include "io/picture/flip.h"
#include "pipeline/look.h"
#include "reference/functions.h"
#include "reference/relax.h"
#include "reference/render.h"

namespace plisse::bench {
namespace {

using Eigen::Index;
using pipeline::WaveSnapshot;

constexpr int rounds = 10;
constexpr double epsilon = 13.2;
constexpr const char* truth = "the reference in double precision, from the same input";

class RootMeanSquare {
 public:
  void add(double error) {
    squares_ += error * error;
    ++count_;
  }
  double value() const { return count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0; }

 private:
  double squares_ = 0;
  std::size_t count_ = 0;
};

double phase_difference(double a, double b) {
  return std::remainder(a - b, 2 * reference::pi);
}

io::Image composed(const reference::Picture& picture, const glm::dvec3& background) {
  io::Image image{picture.width, picture.height, {}};
  for (std::size_t i = 0; i < picture.colour.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double linear = picture.colour[i][c] + (1 - picture.alpha[i]) * background[c];
      image.rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * reference::srgb_encode(linear))));
    }
    image.rgba.push_back(255);
  }
  return image;
}

class Precision {
 public:
  Precision(const Setup& setup, const std::string& name, SuiteReport& report)
      : setup_(setup),
        name_(name),
        report_(report),
        context_(setup.device),
        clock_(fair_clock(context_.info())),
        film_(settings(setup, name), name, context_.info().software) {
    film_.rig.step_to_middle();
  }

  void measure() {
    skin();
    crush();
    relax();
    render();
  }

 private:
  // The surface alone, one sample: what the reference's rasteriser makes too.
  static config::SceneSettings settings(const Setup& setup, const std::string& name) {
    config::SceneSettings result = setup.scene(name, setup.pick(64, 320, 640), setup.pick(52, 256, 512));
    result.output.samples = 1;
    result.output.ground = result.light.shadows = false;
    return result;
  }

  struct Way {
    std::string series;
    std::function<void()> run;
    double error = 0;
  };

  void add(const std::string& pass, const std::string& unit, const std::vector<Way>& ways, double share = 1) {
    std::vector<Case> cases;
    for (const Way& way : ways) cases.push_back({way.series, way.run});
    const auto samples = take_turns(cases, setup_.turns());
    for (std::size_t i = 0; i < ways.size(); ++i) {
      Row row{"precision",
              name_,
              ways[i].series,
              pass,
              samples[i].of(clock_).scaled(share),
              clock_,
              "one pass of one frame"};
      row.error_of = "pass";
      row.error = ways[i].error;
      row.error_unit = unit;
      row.truth = truth;
      report_.rows.push_back(row);
    }
  }

  void skin() {
    const int frame = static_cast<int>(film_.subject.palettes.size() / 2) + 1;
    const scene::Pose pose = film_.scene.animation.pose(frame);
    film_.rig.skin();
    const pipeline::WaveSnapshot gpu = pipeline::read_snapshot(film_.rig.surface());
    const Eigen::Matrix3Xd expected = film_.reference.positions(pose);
    const double box = (expected.rowwise().maxCoeff() - expected.rowwise().minCoeff()).norm();
    RootMeanSquare error;
    for (Index v = 0; v < expected.cols(); ++v)
      error.add((expected.col(v) - gpu.positions.col(v)).norm() / box);
    add("skin", "of the bounding box",
        {{"shader, float",
          [&] {
            film_.rig.skin();
            finish();
          },
          error.value()},
         {"reference, double", [&] { film_.reference.frames(pose, film_.reference.positions(pose)); }, 0}});
  }

  void crush() {
    const auto& reference = film_.reference;
    const pipeline::WaveSnapshot before = pipeline::read_snapshot(film_.rig.surface());
    const auto of_reference = [&] {
      return reference::crush(reference.topology, reference.rest_frames, before.positions, before.frames,
                              reference.wavelength, reference.mask, reference.crush, before.states,
                              reference.bias);
    };
    const auto expected = of_reference();
    film_.rig.crush();
    const pipeline::WaveSnapshot gpu = pipeline::read_snapshot(film_.rig.surface());
    RootMeanSquare error;
    for (std::size_t v = 0; v < expected.size(); ++v) {
      const double W = reference.wavelength[static_cast<Index>(v)];
      error.add((gpu.heights[static_cast<Index>(v)] - expected[v].height) / W);
    }
    add("crush", "of a wavelength, in the height",
        {{"shader, float",
          [&] {
            film_.rig.crush();
            finish();
          },
          error.value()},
         {"reference, double", of_reference, 0}});
  }

  void relax() {
    film_.rig.relax(1, true);  // phases for new waves
    const auto& topology = film_.reference.topology;
    const pipeline::WaveSnapshot before = pipeline::read_snapshot(film_.rig.surface());
    reference::WaveField field = before.field();
    for (int i = 0; i < rounds; ++i) reference::descent_round(topology, field, epsilon);
    film_.rig.relax(rounds, false);
    const pipeline::WaveSnapshot gpu = pipeline::read_snapshot(film_.rig.surface());
    RootMeanSquare error;
    for (Index v = 0; v < field.phases.size(); ++v) {
      const auto i = static_cast<std::size_t>(v);
      if (field.status[i] != reference::Status::set || !(field.weights[v] > 0)) continue;
      error.add(phase_difference(gpu.phases[v], field.phases[v]));
    }
    add("relax, a round", "radians after ten rounds",
        {{"shader, float",
          [&] {
            film_.rig.relax(rounds, false);
            finish();
          },
          error.value()},
         {"reference, double",
          [&] {
            for (int i = 0; i < rounds; ++i) reference::descent_round(topology, field, epsilon);
          },
          0}},
        1.0 / rounds);
  }

  void render() {
    const pipeline::WaveSnapshot waves = pipeline::read_snapshot(film_.rig.surface());
    const auto textures = pipeline::reference_textures(film_.scene);
    reference::Picture drawn;
    const auto of_reference = [&] {
      drawn = reference::render(pipeline::picture_scene(film_.reference, waves, film_.view, textures),
                                film_.target.width(), film_.target.height());
    };
    of_reference();
    const io::Image shader = film_.picture(),
                    expected = composed(drawn, pipeline::look_of(film_.scene).background);
    std::vector<std::uint8_t> mask(drawn.triangle.size());
    for (std::size_t i = 0; i < mask.size(); ++i)
      mask[i] = drawn.triangle[i] >= 0 && !drawn.silhouette[i] ? 1 : 0;
    const double flip = io::flip(expected, shader, mask).mean;
    setup_.save(report_, fmt::format("precision_{}_shader", name_), shader,
                fmt::format("{}: shader, float; FLIP {:.2g}", name_, flip));
    setup_.save(report_, fmt::format("precision_{}_reference", name_), expected,
                fmt::format("{}: reference, double", name_));
    add("render", "mean FLIP over the surface, outlines left out",
        {{"shader, float", [&] { film_.draw(film_.rig.surface()); }, flip},
         {"reference, double", of_reference, 0}});
  }

  const Setup& setup_;
  std::string name_;
  SuiteReport& report_;
  gpu::Context context_;
  Clock clock_;
  Film film_;
};

}  // namespace

SuiteReport measure_precision(const Setup& setup) {
  SuiteReport report;
  report.name = "precision";
  report.title = "Precision: shader and reference";
  report.note =
      "Each pass from the same state: by the shader in single precision and by the reference in double "
      "precision, which is the truth (its own error is 0 by definition). Errors are root mean squares over "
      "vertices. The reference is written to be read, not to be quick.";
  Precision(setup, "sleeve", report).measure();
  if (setup.effort != Effort::smoke) Precision(setup, "model_b", report).measure();
  return report;
}

}  // namespace plisse::bench
