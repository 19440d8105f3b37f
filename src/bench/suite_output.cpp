// Output: samples a pixel compared with a picture of sixteen times the pixels, PNG level over bytes, and
// whole runs over the number of threads.
#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <thread>

#include "base/atomic_file.h"
#include "base/colour.h"
#include "bench/film.h"
#include "bench/suite.h"
#include "config/settings.h"
#include "io/picture/flip.h"
#include "io/picture/png.h"
#include "pipeline/render.h"

namespace plisse::bench {
namespace {

const std::string scene_name = "sleeve";

// The mean of each `factor` × `factor` pixels, in linear light.
io::Image shrunk(const io::Image& large, int factor) {
  io::Image small{large.width / factor, large.height / factor, {}};
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      glm::dvec3 sum(0);
      for (int j = 0; j < factor; ++j) {
        for (int i = 0; i < factor; ++i) {
          const auto at =
              4 * (static_cast<std::size_t>(y * factor + j) * static_cast<std::size_t>(large.width) +
                   static_cast<std::size_t>(x * factor + i));
          for (int c = 0; c < 3; ++c)
            sum[c] += srgb_to_linear(large.rgba[at + static_cast<std::size_t>(c)] / 255.0);
        }
      }
      for (int c = 0; c < 3; ++c)
        small.rgba.push_back(
            static_cast<std::uint8_t>(std::lround(255 * linear_to_srgb(sum[c] / (factor * factor)))));
      small.rgba.push_back(255);
    }
  }
  return small;
}

io::Image drawn(const Setup& setup, int width, int height, int samples, bool software,
                std::optional<Film>& film) {
  config::SceneSettings settings = setup.scene(scene_name, width, height);
  settings.output.samples = samples;
  film.emplace(settings, scene_name, software);
  film->rig.step_to_middle();
  return film->picture();
}

void measure_samples(const Setup& setup, SuiteReport& report) {
  const gpu::Context context(setup.device);
  const bool software = context.info().software;
  const Clock clock = fair_clock(context.info());
  const int width = setup.pick(64, 640, 1280), height = setup.pick(52, 512, 1024), factor = 4;
  io::Image truth;
  {
    std::optional<Film> large;
    truth = shrunk(drawn(setup, factor * width, factor * height, 4, software, large), factor);
  }
  setup.save(report, "output_truth", truth, "64 samples a pixel");
  std::optional<Film> films[2];
  std::vector<Case> cases;
  std::vector<double> errors;
  for (std::size_t i = 0; i < 2; ++i) {
    const int samples = i == 0 ? 1 : 4;
    const io::Image picture = drawn(setup, width, height, samples, software, films[i]);
    errors.push_back(io::flip(truth, picture).mean);
    setup.save(report, fmt::format("output_{}", samples), picture,
               fmt::format("samples = {}, FLIP {:.3f}", samples, errors.back()));
    cases.push_back(
        {fmt::format("samples = {}", samples), [&films, i] { films[i]->draw(films[i]->rig.surface()); }});
  }
  const auto samples = take_turns(cases, setup.turns());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Row row{"output", scene_name, "samples a pixel", cases[i].name, samples[i].of(clock), clock, "a picture"};
    row.error_of = "picture";
    row.error = errors[i];
    row.error_unit = "mean FLIP";
    row.truth = "a picture of 16 times the pixels, 4 samples each, averaged in linear light";
    report.rows.push_back(row);
  }

  // PNG: the pixels do not depend on the level, so time and bytes are compared.
  const io::Image picture = films[1]->picture();
  std::vector<std::size_t> bytes;
  std::vector<Case> levels;
  for (const io::PngLevel level : {io::PngLevel::stored, io::PngLevel::quick, io::PngLevel::small}) {
    const io::PngOptions options{level, ""};
    bytes.push_back(io::encode_png(picture, options).size());
    levels.push_back({fmt::format("level {}", static_cast<int>(level)),
                      [&picture, options] { io::encode_png(picture, options); }});
  }
  const auto encoded = take_turns(levels, setup.turns());
  for (std::size_t i = 0; i < levels.size(); ++i) {
    Row row{"output", scene_name, "PNG", levels[i].name, encoded[i].of(Clock::cpu), Clock::cpu, "a picture"};
    row.error_of = "file";
    row.error = static_cast<double>(bytes[i]) / 1e6;
    row.error_unit = "MB a frame (no pixel differs)";
    row.truth = "0 MB";
    report.rows.push_back(row);
  }
}

// Whole runs, files and all, by --threads.
void measure_threads(const Setup& setup, SuiteReport& report) {
  const int frames = setup.pick(2, 12, 48);
  config::SceneSettings settings =
      setup.scene(scene_name, setup.pick(64, 640, 1280), setup.pick(52, 512, 1024));
  settings.model.frames = fmt::format("1-{}", frames);
  const auto folder = setup.folder / "frames";
  const auto run = [&](std::size_t threads, const std::string& name) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    pipeline::RenderRequest request;
    request.scene = settings;
    request.scene.output.path = (folder / name / "frame_####.png").string();
    request.device = setup.device;
    pipeline::render(request, {});
  };
  std::vector<Case> cases;
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  for (std::size_t threads = 1; threads <= 2 * cores; threads *= 2) {
    const std::string name = fmt::format("{} thread{}", threads, threads > 1 ? "s" : "");
    cases.push_back({name, [&run, threads, name] { run(threads, name); }});
  }
  const auto samples = take_turns(cases, {setup.pick(1, 2, 5), 0});
  for (std::size_t i = 0; i < cases.size(); ++i) {
    int different = 0;
    for (int frame = 1; frame <= frames; ++frame) {
      const auto file = [&](std::size_t c) {
        return read_whole_file(folder / cases[c].name / fmt::format("frame_{:04}.png", frame));
      };
      different += file(i) == file(0) ? 0 : 1;
    }
    Row row{"output",
            scene_name,
            "whole run",
            cases[i].name,
            samples[i].of(Clock::wall).scaled(1.0 / frames),
            Clock::wall,
            "a frame of a whole run"};
    row.error_of = "bytes";
    row.error = different;
    row.error_unit = "frames whose bytes differ";
    row.truth = "the run on one thread";
    report.rows.push_back(row);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace

SuiteReport measure_output(const Setup& setup) {
  SuiteReport report;
  report.name = "output";
  report.title = "Output: samples, PNG level, threads";
  report.note =
      "Samples a pixel against a picture of sixteen times as many pixels; PNG levels by the size of the "
      "file; whole runs, "
      "loading and writing included, by the threads that encode and write beside the renderer (the wall "
      "clock counts there).";
  measure_samples(setup, report);
  measure_threads(setup, report);
  return report;
}

}  // namespace plisse::bench
