#include <fmt/format.h>

#include <functional>
#include <memory>

#include "benchmark/effort.h"
#include "benchmark/sections.h"

namespace plisse::benchmark {

void compare_shaders(Report& report, const Effort& effort, const std::string& folder) {
  constexpr int rounds = 10;
  Table table{fmt::format("Shaders of {} against the built-in ones", folder),
              "",
              {"model", "pass", "built-in, CPU ms", "the folder's, CPU ms", "ratio"},
              {}};
  const Subject subjects[] = {scene_subject("shirt", effort), scene_subject("model_a", effort),
                              grid_subject(effort)};
  for (const Subject& subject : subjects) {
    const gpu::Context context;
    const Clock clock = fair_clock(context.info());
    Rig built_in(subject, context.info().software), other(subject, context.info().software, folder);
    built_in.step_to_middle();
    other.step_to_middle();
    const auto pass = [&](const std::string& its) {
      return std::make_unique<passes::RenderPass>(bare(subject.look), subject.profile, subject.parts,
                                                  subject.textures, its);
    };
    const auto built_in_pass = pass(""), other_pass = pass(folder);
    const gpu::Target single(effort.width, effort.height, 1, gpu::Target::Format::srgb8);
    const gpu::Target multi(effort.width, effort.height, 4, gpu::Target::Format::srgb8);
    std::vector<Case> cases;
    const auto add = [&](const char* name, const std::function<void(Rig&, passes::RenderPass&)>& run) {
      cases.push_back({name, [&, run] {
                         run(built_in, *built_in_pass);
                         finish();
                       }});
      cases.push_back({name, [&, run] {
                         run(other, *other_pass);
                         finish();
                       }});
    };
    add("skin", [](Rig& rig, auto&) { rig.skin(); });
    add("crush", [](Rig& rig, auto&) { rig.crush(); });
    add("relax, ten rounds", [](Rig& rig, auto&) { rig.relax(rounds, false); });
    add("render", [&](Rig& rig, auto& its) { draw(its, rig, subject, single); });
    add("render, 4× MSAA", [&](Rig& rig, auto& its) { draw(its, rig, subject, multi); });
    const auto samples = take_turns(cases, effort);
    for (std::size_t i = 0; i < cases.size(); i += 2) {
      table.rows.push_back({subject.name, cases[i].name, Cell(samples[i].of(clock).scaled(1e3), 3),
                            Cell(samples[i + 1].of(clock).scaled(1e3), 3),
                            Cell(ratio(samples[i + 1], samples[i], clock), 3)});
    }
  }
  report.tables.push_back(table);
}

}  // namespace plisse::benchmark
