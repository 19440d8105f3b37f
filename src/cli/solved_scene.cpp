#include "cli/solved_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>

#include "base/atomic_file.h"
#include "base/log.h"
#include "base/progress.h"
#include "cloth/solve_scene.h"

namespace plisse::cli {
namespace {

using nlohmann::ordered_json;

ordered_json to_json(const cloth::SolvedFrame& frame) {
  ordered_json json = {{"frame", frame.followed.frame},
                       {"moved_rms_m", frame.followed.moved_rms},
                       {"moved_most_m", frame.followed.moved_most},
                       {"length_kept", frame.followed.length_kept},
                       {"compression", frame.taken.compression},
                       {"untaken", frame.taken.untaken},
                       {"crest_angle_deg", 180 / std::numbers::pi * frame.taken.crest_angle},
                       {"where_compressed", frame.taken.where_compressed},
                       {"waves", frame.waves},
                       {"wavelength_m", frame.taken.wavelength},
                       {"max_amplitude_m", frame.max_amplitude},
                       {"converged", frame.converged},
                       {"reason", frame.reason},
                       {"follow_s", frame.followed.seconds},
                       {"solve_s", frame.solve_s}};
  if (frame.followed.nearest_body > 0) {
    json["nearest_body_m"] = frame.followed.nearest_body;
    json["brought_out"] = frame.followed.brought_out;
  }
  return json;
}

}  // namespace

SolvedRun SolveArguments::run(const config::SceneSettings& scene, const CommonArguments& common,
                              const std::function<void()>& before) const {
  SolvedRun run;
  if (!scene.solve.on) return run;
  if (!common.json().empty() && common.json() != "-") check_writable(common.json());
  before();
  cloth::SolvedScene solved;
  {
    std::optional<Progress> progress;  // one a stage: each has a speed of its own
    std::string stage;
    solved = cloth::solve_scene({scene, cache_.folder(), [&](std::string_view what, int done, int of) {
                                   if (!progress || stage != what) {
                                     stage = what;
                                     progress.emplace(Progress::style_for_stderr(common.quiet()));
                                   }
                                   progress->update(done, of, stage);
                                 }});
  }
  run.memory = std::move(solved.memory);
  run.interrupted = solved.interrupted;
  if (run.interrupted) return run;
  ordered_json frames = ordered_json::array();
  int unconverged = 0;
  for (const cloth::SolvedFrame& frame : solved.frames) {
    frames.push_back(to_json(frame));
    if (frame.converged) continue;
    run.converged = false;
    if (++unconverged <= 10)
      log::warn(fmt::format("frame {}: NOT CONVERGED: {}; it is drawn as it is", frame.followed.frame,
                            frame.reason));
  }
  if (unconverged > 10) log::warn(fmt::format("{} frames in all did not converge", unconverged));
  const std::string handed =
      solved.follow > 0 ? fmt::format("what is shorter than {:.3g} m", solved.follow) : "nothing";
  log::notice(fmt::format("{} vertices in {} shell{}: {} is handed to waves; cloth of {:.3g} mm",
                          solved.vertices, solved.shells, solved.shells == 1 ? "" : "s", handed,
                          1e3 * solved.thickness));
  run.report = {{"vertices", solved.vertices},
                {"faces", solved.faces},
                {"shells", solved.shells},
                {"follow_m", solved.follow},
                {"thickness_m", solved.thickness},
                {"converged", run.converged},
                {"frames", frames}};
  run.report.update(reused_json(solved.reuse.answers, solved.reuse.saved_s));
  const auto still = std::ranges::count_if(solved.frames, [&](const cloth::SolvedFrame& frame) {
    return static_cast<std::size_t>(frame.followed.still) == solved.shells;
  });
  if (still > 0) run.report["skipped"]["moved as a whole"] = still;
  return run;
}

}  // namespace plisse::cli
