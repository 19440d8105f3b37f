// Tables 1 and 2 of Loviscach 2006: Pentium 4 at 2.5 GHz, GeForce 6800 GT, 1280×1024.
#include <algorithm>

#include "benchmark/effort.h"
#include "benchmark/film.h"
#include "benchmark/sections.h"

namespace plisse::benchmark {
namespace {

struct Table1Row {
  const char* scene;
  double vertices, pixels, fps;
};
constexpr Table1Row table1[] = {
    {"shirt", 455, 330e3, 328}, {"zeppelin", 508, 260e3, 540}, {"curtain", 92, 505e3, 537}};

struct Table2Column {
  const char* scene;
  double vertices, pixels;
  double ms[5];  // skin, crush, relax, render; in all, with what is no shader
};
constexpr Table2Column table2[] = {{"model_a", 100, 940e3, {0.06, 0.08, 0.11, 3.11, 3.45}},
                                   {"model_b", 5977, 55e3, {0.25, 1.83, 1.75, 5.01, 8.90}}};

void measure_table1(Report& report, const Effort& effort) {
  Table table{"The paper's Table 1",
              "The paper's numbers (GeForce 6800 GT, 1280×1024, no antialiasing), then ours: the scenes of "
              "assets/ with all "
              "their light, from pose to finished picture, neither read back nor written. Pixels are the "
              "clip's average.",
              {"model", "vertices", "ours", "pixels", "ours", "frames/s", "ours", "ours, 4× MSAA",
               "CPU ms per frame", "CPU ms, 4×"},
              {}};
  const int runs = std::min(effort.samples, 3);
  for (const Table1Row& row : table1) {
    const gpu::Context context;
    const config::SceneSettings settings[] = {film_settings(row.scene, effort, 1),
                                              film_settings(row.scene, effort, 4)};
    std::vector<double> fps[2], cpu[2];
    for (int run = 0; run < runs; ++run) {
      for (std::size_t i = 0; i < 2; ++i) {
        const Sample sample = film_without_files(settings[i], effort, false, context.info().software);
        fps[i].push_back(1 / sample.wall_s);
        cpu[i].push_back(1e3 * sample.cpu_s);
      }
    }
    table.rows.push_back({row.scene, Cell(row.vertices, 0),
                          Cell(scene_subject(row.scene, effort).vertices(), 0), Cell(row.pixels, 0),
                          Cell(average_covered_pixels(settings[0], effort), 0), Cell(row.fps, 0),
                          Cell(distribution(fps[0]), 0), Cell(distribution(fps[1]), 0),
                          Cell(distribution(cpu[0]), 1), Cell(distribution(cpu[1]), 1)});
  }
  report.tables.push_back(table);
}

void measure_table2(Report& report, const Effort& effort) {
  Table table{"The paper's Table 2",
              "Milliseconds a frame by stage: the paper's (the change in frame rate when the stage is left "
              "out), then ours by "
              "the wall clock and in CPU time, without antialiasing. Relax is one round.",
              {"stage", "A", "A, ours", "A, CPU", "B", "B, ours", "B, CPU"},
              {}};
  const char* stages[] = {"vertices", "pixels", "skin", "crush", "relax", "render", "in all"};
  for (const char* stage : stages) table.rows.push_back({stage});
  for (const Table2Column& column : table2) {
    const Subject subject = scene_subject(column.scene, effort);
    const gpu::Context context;
    Rig rig(subject, context.info().software);
    rig.step_to_middle();
    passes::RenderPass pass(subject.look, subject.profile, subject.parts, subject.textures, "");
    const gpu::Target target(effort.width, effort.height, 1, gpu::Target::Format::srgb8);
    const auto samples = take_turns({{"skin",
                                      [&] {
                                        rig.skin();
                                        finish();
                                      }},
                                     {"crush",
                                      [&] {
                                        rig.crush();
                                        finish();
                                      }},
                                     {"relax",
                                      [&] {
                                        rig.relax(1, true);
                                        finish();
                                      }},
                                     {"render", [&] { draw(pass, rig, subject, target); }},
                                     {"in all",
                                      [&] {
                                        rig.step();
                                        draw(pass, rig, subject, target);
                                      }}},
                                    effort);
    const double pixels = average_covered_pixels(film_settings(column.scene, effort, 1), effort);
    table.rows[0].insert(table.rows[0].end(),
                         {Cell(column.vertices, 0), Cell(subject.vertices(), 0), Cell("")});
    table.rows[1].insert(table.rows[1].end(), {Cell(column.pixels, 0), Cell(pixels, 0), Cell("")});
    for (std::size_t i = 0; i < samples.size(); ++i) {
      table.rows[i + 2].insert(table.rows[i + 2].end(),
                               {Cell(column.ms[i], 2), Cell(samples[i].of(Clock::wall).scaled(1e3), 2),
                                Cell(samples[i].of(Clock::cpu).scaled(1e3), 2)});
    }
  }
  report.tables.push_back(table);
}

}  // namespace

void measure_paper(Report& report, const Effort& effort) {
  measure_table1(report, effort);
  measure_table2(report, effort);
}

}  // namespace plisse::benchmark
