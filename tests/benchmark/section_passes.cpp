#include <vector>

#include "benchmark/effort.h"
#include "benchmark/sections.h"

namespace plisse::benchmark {

void measure_passes(Report& report, const Effort& effort) {
  constexpr int rounds = 10;
  Table table{
      "Passes",
      "One pass of one frame, in the middle of the clip. Relax is a round of descent (of ten in a row). "
      "Render is the "
      "surface alone, resolved, at the picture's full size; its cost is that of pixels, not of vertices.",
      {"model", "vertices", "pass", "CPU ms", "CPU ns per vertex", "wall ms"},
      {}};
  for (const Subject& subject :
       {scene_subject("model_a", effort), scene_subject("model_b", effort), grid_subject(effort)}) {
    const gpu::Context context;
    Rig rig(subject, context.info().software);
    rig.step_to_middle();
    passes::RenderPass pass(bare(subject.look), subject.profile, subject.parts, subject.textures, "");
    const gpu::Target single(effort.width, effort.height, 1, gpu::Target::Format::srgb8);
    const gpu::Target multi(effort.width, effort.height, 4, gpu::Target::Format::srgb8);
    const std::vector<Case> cases{
        {"skin",
         [&] {
           rig.skin();
           finish();
         }},
        {"crush",
         [&] {
           rig.crush();
           finish();
         }},
        {"relax, a round",
         [&] {
           rig.relax(rounds, false);
           finish();
         }},
        {"render", [&] { draw(pass, rig, subject, single); }},
        {"render, 4× MSAA", [&] { draw(pass, rig, subject, multi); }},
    };
    const auto samples = take_turns(cases, effort);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const double share = i == 2 ? 1.0 / rounds : 1.0;
      const Distribution cpu = samples[i].of(Clock::cpu).scaled(share),
                         wall = samples[i].of(Clock::wall).scaled(share);
      table.rows.push_back({subject.name, Cell(subject.vertices(), 0), cases[i].name,
                            Cell(cpu.scaled(1e3), 3), Cell(cpu.scaled(1e9 / subject.vertices()), 0),
                            Cell(wall.scaled(1e3), 3)});
    }
  }
  report.tables.push_back(table);
}

}  // namespace plisse::benchmark
