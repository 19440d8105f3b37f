#include <fmt/format.h>

#include <memory>

#include "benchmark/effort.h"
#include "benchmark/film.h"
#include "benchmark/sections.h"

namespace plisse::benchmark {

void measure_shading(Report& report, const Effort& effort) {
  Table table{
      "The wave shader against plain textured Phong",
      "The surface alone, cleared, drawn, resolved. *Same light* is the wave shader's own light on the "
      "surface without "
      "waves; Phong is shaders/phong.frag, one light. Ratios are of CPU time, of neighbouring samples.",
      {"model", "pixels", "MSAA", "shader", "CPU ms", "wall ms", "waves / this"},
      {}};
  for (const Subject& subject : {scene_subject("shirt", effort), scene_subject("model_a", effort)}) {
    const gpu::Context context;
    const Clock clock = fair_clock(context.info());
    Rig rig(subject, context.info().software);
    rig.step_to_middle();
    passes::Look look = bare(subject.look), plain = look, phong = look;
    plain.plain = phong.plain = true;
    phong.phong = true;
    const auto pass_of = [&](const passes::Look& its, const std::vector<passes::DrawPart>& parts) {
      return std::make_unique<passes::RenderPass>(its, subject.profile, parts, subject.textures, "");
    };
    const auto waves = pass_of(look, subject.parts), same_light = pass_of(plain, subject.parts),
               phong_pass = pass_of(phong, subject.parts), nothing = pass_of(phong, {});
    const gpu::Target floats(effort.width, effort.height, 1, gpu::Target::Format::rgba32f);
    const auto pixels = static_cast<double>(covered_pixels(*waves, rig.surface(), subject.view, floats));
    for (int samples_a_pixel : {1, 4}) {
      const gpu::Target target(effort.width, effort.height, samples_a_pixel, gpu::Target::Format::srgb8);
      const std::vector<Case> cases{{"waves", [&] { draw(*waves, rig, subject, target); }},
                                    {"Phong", [&] { draw(*phong_pass, rig, subject, target); }},
                                    {"same light", [&] { draw(*same_light, rig, subject, target); }},
                                    {"nothing drawn", [&] { draw(*nothing, rig, subject, target); }}};
      const auto samples = take_turns(cases, effort);
      for (std::size_t i = 0; i < cases.size(); ++i) {
        const bool comparable = i == 1 || i == 2;
        table.rows.push_back({subject.name, Cell(pixels, 0), samples_a_pixel == 1 ? "–" : "4×", cases[i].name,
                              Cell(samples[i].of(Clock::cpu).scaled(1e3), 1),
                              Cell(samples[i].of(Clock::wall).scaled(1e3), 1),
                              comparable ? Cell(ratio(samples[0], samples[i], clock), 2) : Cell("")});
      }
      if (samples_a_pixel == 1) {
        report.targets.push_back({fmt::format("waves / Phong, {}, no MSAA", subject.name), 1.5,
                                  ratio(samples[0], samples[1], clock)});
      }
    }
  }
  report.tables.push_back(table);
}

}  // namespace plisse::benchmark
