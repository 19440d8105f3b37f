// Every pass against what no program can beat on this device: moving the bytes that it must read and write
// once, and launching its work. Small surfaces are bound by launches, large ones by memory; what is above
// both is arithmetic, gathers that miss caches, and pixels.
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/effort.h"
#include "benchmark/film.h"
#include "benchmark/sections.h"
#include "gpu/timer.h"

namespace plisse::benchmark {
namespace {

struct Work {
  std::string name;
  std::function<void()> run;
  double bytes = 0;     // that it must move: each buffer once, a picture's samples as they are written
  double launches = 0;  // dispatches or draws, one waiting for the other
};

// Seconds by the device's own clock (timer queries; on a software renderer the wall clock round a glFinish),
// work and work in turn as in take_turns.
std::vector<Distribution> device_seconds(const std::vector<Work>& works, const Turns& turns, bool software) {
  std::vector<std::vector<double>> seconds(works.size());
  gpu::StageTimer timer(software);
  std::vector<int> repeats(works.size(), 1);
  const auto sample = [&](std::size_t i) {
    timer.begin("work");
    for (int r = 0; r < repeats[i]; ++r) works[i].run();
    timer.end();
    return 1e-3 * timer.collect()["work"] / repeats[i];
  };
  for (std::size_t i = 0; i < works.size(); ++i) {
    sample(i);
    repeats[i] = std::clamp(static_cast<int>(turns.seconds / std::max(sample(i), 1e-7)), 1, 1000);
  }
  for (int turn = 0; turn < turns.samples; ++turn)
    for (std::size_t i = 0; i < works.size(); ++i) seconds[i].push_back(sample(i));
  std::vector<Distribution> result;
  for (auto& values : seconds) result.push_back(distribution(std::move(values)));
  return result;
}

double sum(std::initializer_list<const gpu::Buffer*> buffers) {
  double bytes = 0;
  for (const gpu::Buffer* buffer : buffers) bytes += static_cast<double>(buffer->bytes());
  return bytes;
}

std::vector<Work> passes_of(Rig& rig) {
  const passes::SurfaceBuffers& s = rig.surface();
  const auto bytes = [](const gpu::Buffer& buffer) { return static_cast<double>(buffer.bytes()); };
  return {
      // Skin and the frames after it, which start from its normal.
      {"skin", [&rig] { rig.skin(); },
       sum({&s.bind_places, &s.influences, &s.target_deltas, &s.positions, &s.positions, &s.corner_offsets,
            &s.corners, &s.tangent_neighbours, &s.frames}) +
           bytes(s.frames),
       2},
      {"crush", [&rig] { rig.crush(); },
       sum({&s.constants, &s.positions, &s.frames, &s.offsets, &s.neighbours, &s.rest_rows, &s.biases}) +
           2 * sum({&s.states, &s.phases}) + sum({&s.waves, &s.world_waves}),
       1},
      {"relax, a round", [&rig] { rig.relax(1, false); },
       2 * bytes(s.phases) + sum({&s.offsets, &s.neighbours, &s.positions, &s.world_waves}), 1},
  };
}

// The surface's corners as the vertex shader pulls them, and the picture: cleared, written where the surface
// is, and with more than one sample read and written once more to be resolved.
double bytes_of_picture(const passes::SurfaceBuffers& s, const gpu::Target& target, double covered) {
  const double pixels = static_cast<double>(target.width()) * target.height(), samples = target.samples();
  constexpr double sample = 8;  // sRGB bytes and a float of depth
  const double resolve = samples > 1 ? pixels * (4 * samples + 4) : 0;
  return sum({&s.triangle_corners, &s.render_vertices, &s.positions, &s.frames, &s.waves, &s.phases,
              &s.constants}) +
         sample * samples * (pixels + covered) + resolve;
}

struct Limits {
  double bytes_per_s = 0, launch_s = 0;
};

Limits limits_of(const Effort& effort, bool software) {
  const std::size_t size = effort.samples > 1 ? 256U << 20U : 1U << 20U;
  const gpu::Buffer from(size), to(size);
  const Subject least = bench::grid_subject(4, 16, 16);
  Rig rig(least, software);
  const std::vector<Work> works{
      {"copy", [&] { glCopyNamedBufferSubData(from.id(), to.id(), 0, 0, static_cast<GLsizeiptr>(size)); }},
      {"launch", [&] { rig.relax(100, false); }},
  };
  const auto seconds = device_seconds(works, effort, software);
  return {2 * static_cast<double>(size) / seconds[0].median, seconds[1].median / 100};
}

}  // namespace

void measure_device(Report& report, const Effort& effort) {
  Limits limits;
  const char* clock = "";
  {
    const gpu::Context context;
    const bool software = context.info().software;
    limits = limits_of(effort, software);
    clock = software ? "the wall clock round a glFinish, as timer queries say nothing on a software renderer"
                     : "timer queries";
  }
  Table table{"Every pass against the device's limits",
              fmt::format("By {}. Memory: {:.1f} GB/s, a copy from buffer to buffer, both ways counted; a "
                          "launch: {:.1f} µs, a round of relax "
                          "on four vertices, each waiting for the last. MB: what a pass must move. The last "
                          "column is its time over the larger "
                          "of both limits: 1 cannot be beaten.",
                          clock, 1e-9 * limits.bytes_per_s, 1e6 * limits.launch_s),
              {"model", "vertices", "pass", "picture", "ms", "MB", "GB/s", "time / limit"},
              {}};
  const bool tiny = effort.samples == 1;
  const std::vector<std::pair<int, int>> sizes =
      tiny ? std::vector<std::pair<int, int>>{{64, 52}, {96, 54}}
           : std::vector<std::pair<int, int>>{{1280, 1024}, {3840, 2160}};
  for (const int model : {0, 1, 2, 3}) {
    for (const auto& [width, height] : sizes) {
      Effort at = effort;
      at.width = width;
      at.height = height;
      const Subject subject =
          model < 2 ? scene_subject(model == 0 ? "model_a" : "model_b", at)
                    : bench::grid_subject((model == 2 ? 1 : 10) * effort.grid_vertices, width, height);
      const gpu::Context context;
      const bool software = context.info().software;
      Rig rig(subject, software);
      rig.step_to_middle();
      passes::RenderPass pass(bare(subject.look), subject.profile, subject.parts, subject.textures, "");
      const gpu::Target single(width, height, 1, gpu::Target::Format::srgb8),
          multi(width, height, 4, gpu::Target::Format::srgb8);
      double covered = 0;
      {
        const gpu::Target floats(width, height, 1, gpu::Target::Format::rgba32f);
        covered = static_cast<double>(covered_pixels(pass, rig.surface(), subject.view, floats));
      }
      std::vector<Work> works;
      if (width == sizes.front().first) works = passes_of(rig);
      for (const gpu::Target* target : {&single, &multi})
        works.push_back({target == &single ? "render" : "render, 4× MSAA",
                         [&, target] { pass.draw(rig.surface(), subject.view, *target, software); },
                         bytes_of_picture(rig.surface(), *target, covered), target == &single ? 1.0 : 2.0});
      Turns turns = effort;
      turns.samples = std::min(turns.samples, 7);
      const auto seconds = device_seconds(works, turns, software);
      for (std::size_t i = 0; i < works.size(); ++i) {
        const double limit =
            std::max(works[i].bytes / limits.bytes_per_s, works[i].launches * limits.launch_s);
        table.rows.push_back(
            {subject.name, Cell(subject.vertices(), 0), works[i].name,
             works[i].name.starts_with("render") ? fmt::format("{} × {}", width, height) : "",
             Cell(seconds[i].scaled(1e3), 3), Cell(1e-6 * works[i].bytes, 2),
             Cell(1e-9 * works[i].bytes / seconds[i].median, 2), Cell(seconds[i].median / limit, 1)});
      }
    }
  }
  report.tables.push_back(table);
}

}  // namespace plisse::benchmark
