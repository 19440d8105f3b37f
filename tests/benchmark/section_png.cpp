#include "benchmark/plain_png.h"

#include "benchmark/effort.h"
#include "benchmark/sections.h"
#include "io/picture/png.h"

namespace plisse::benchmark {

void measure_png(Report& report, const Effort& effort) {
  const Subject subject = scene_subject("shirt", effort);
  const gpu::Context context;
  Rig rig(subject, context.info().software);
  rig.step_to_middle();
  passes::RenderPass pass(subject.look, subject.profile, subject.parts, subject.textures, "");
  const gpu::Target target(effort.width, effort.height, 4, gpu::Target::Format::srgb8);
  draw(pass, rig, subject, target);
  const io::Image image{effort.width, effort.height, target.read_rgba8()};
  // What `encode_png` makes of an opaque picture itself.
  std::vector<std::uint8_t> rgb;
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    if (i % 4 != 3) rgb.push_back(image.rgba[i]);
  }
  std::size_t ours = 0, stock_rgb = 0, stock_rgba = 0;
  const std::vector<Case> cases{
      {"io::encode_png", [&] { ours = io::encode_png(image).size(); }},
      {"stb's own zlib, RGB", [&] { stock_rgb = stock_png(rgb.data(), image.width, image.height, 3); }},
      {"stb's own zlib, RGBA",
       [&] { stock_rgba = stock_png(image.rgba.data(), image.width, image.height, 4); }}};
  const auto samples = take_turns(cases, effort);
  Table table{
      "PNG encoding",
      "The shirt with ground and shadow, in memory; both drop nothing but the alpha that is 255 everywhere.",
      {"encoder", "CPU ms", "kB", "ours / this, CPU"},
      {}};
  const std::size_t sizes[] = {ours, stock_rgb, stock_rgba};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    table.rows.push_back({cases[i].name, Cell(samples[i].of(Clock::cpu).scaled(1e3), 1),
                          Cell(static_cast<double>(sizes[i]) * 1e-3, 0),
                          i == 0 ? Cell("") : Cell(ratio(samples[0], samples[i], Clock::cpu), 3)});
  }
  report.tables.push_back(table);
  report.targets.push_back({"PNG / stb's own", 0.25, ratio(samples[0], samples[1], Clock::cpu)});
}

}  // namespace plisse::benchmark
