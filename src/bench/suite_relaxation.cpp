// Mode, number of rounds and interval of relax: misfit of neighbouring waves, and the difference of the
// picture from one with converged phases in every frame.
#include <fmt/format.h>

#include <cmath>

#include "bench/film.h"
#include "bench/suite.h"
#include "io/picture/flip.h"
#include "reference/relax.h"

namespace plisse::bench {
namespace {

struct Setting {
  std::string series, label;
  config::RelaxSettings relax;
};

config::RelaxSettings relaxation(config::RelaxMode mode, int rounds, double epsilon = 13.2,
                                 int interval = 1) {
  config::RelaxSettings settings;
  settings.mode = mode;
  settings.rounds = rounds;
  settings.epsilon = epsilon;
  settings.interval = interval;
  return settings;
}

std::vector<Setting> settings_to_try() {
  using enum config::RelaxMode;
  std::vector<Setting> settings;
  for (const int rounds : {1, 2, 4, 16, 64})
    settings.push_back(
        {"smooth", fmt::format("{} round{}", rounds, rounds > 1 ? "s" : ""), relaxation(smooth, rounds)});
  for (const int rounds : {1, 4, 16, 64})
    settings.push_back(
        {"descent", fmt::format("{} round{}", rounds, rounds > 1 ? "s" : ""), relaxation(descent, rounds)});
  for (const double epsilon : {4.0, 8.0, 18.0})
    settings.push_back({"smooth, other ε", fmt::format("ε {}", epsilon), relaxation(smooth, 1, epsilon)});
  for (const int interval : {2, 4, 8})
    settings.push_back(
        {"smooth, interval", fmt::format("every {}", interval), relaxation(smooth, 1, 13.2, interval)});
  return settings;
}

constexpr int converged_rounds = 256;

// Frames that are measured, 0-based and ascending; the last one ends the run.
std::vector<int> looks(std::size_t clip, int most) {
  const int last = std::min(static_cast<int>(clip), most) - 1;
  return {last / 3, 2 * last / 3, last};
}

struct Look {
  io::Image picture, converged;  // as the setting left it, and after many more rounds of the same moment
  double misfit = 0;             // E[d²], turns²
};

class Clip {
 public:
  Clip(Film& film, std::vector<int> frames) : film_(film), frames_(std::move(frames)) {}

  void run(const config::RelaxSettings& settings) const {
    film_.rig.restart();
    for (int frame = 0; frame <= frames_.back(); ++frame) film_.rig.advance(settings);
    finish();
  }
  std::vector<Look> look(const config::RelaxSettings& settings) const {
    std::vector<Look> result;
    film_.rig.restart();
    for (int frame = 0; frame <= frames_.back(); ++frame) {
      film_.rig.advance(settings);
      if (frame != frames_[result.size()]) continue;
      Look& look = result.emplace_back();
      look.picture = film_.picture();
      look.misfit = misfit();
      const auto kept = film_.rig.surface().phases.read<glm::vec2>();
      film_.rig.relax(converged_rounds, false);
      look.converged = film_.picture();
      film_.rig.surface().phases.write(kept);
    }
    return result;
  }
  // For each measured frame, where the surface is.
  std::vector<std::vector<std::uint8_t>> masks() const {
    std::vector<std::vector<std::uint8_t>> result;
    film_.rig.restart();
    for (int frame = 0; frame <= frames_.back(); ++frame) {
      film_.rig.advance({});
      if (frame == frames_[result.size()]) result.push_back(film_.covered());
    }
    return result;
  }
  int frames() const { return frames_.back() + 1; }

 private:
  double misfit() const {
    return reference::misfit(film_.reference.topology, pipeline::read_snapshot(film_.rig.surface()).field());
  }
  Film& film_;
  std::vector<int> frames_;
};

void measure_scene(const Setup& setup, const std::string& name, SuiteReport& report) {
  const gpu::Context context(setup.device);
  const Clock clock = fair_clock(context.info());
  const int width = setup.pick(64, 480, 640), height = setup.pick(52, 384, 512);
  Film film(setup.scene(name, width, height), name, context.info().software);
  const Clip clip(film, looks(film.subject.palettes.size(), setup.pick(4, 37, 37)));
  const auto masks = clip.masks();
  const auto settings = settings_to_try();
  std::vector<Case> cases;
  for (const Setting& setting : settings)
    cases.push_back({setting.label, [&clip, relax = setting.relax] { clip.run(relax); }});
  const auto samples = take_turns(cases, {setup.turns().samples, 0});

  for (std::size_t i = 0; i < settings.size(); ++i) {
    const Setting& setting = settings[i];
    const auto looks = clip.look(setting.relax);
    double misfit = 0, image = 0;
    for (std::size_t l = 0; l < looks.size(); ++l) {
      misfit += looks[l].misfit / static_cast<double>(looks.size());
      image +=
          io::flip(looks[l].converged, looks[l].picture, masks[l]).mean / static_cast<double>(looks.size());
    }
    Row row{"relaxation",
            name,
            setting.series,
            setting.label,
            samples[i].of(clock).scaled(1.0 / clip.frames()),
            clock,
            "a frame's skin, crush and relax"};
    row.error_of = "phases";
    row.error = 360 * std::sqrt(misfit);
    row.error_unit = "degrees, root mean square over edges";
    row.truth = "0: neighbouring waves meet";
    report.rows.push_back(row);
    row.error_of = "picture";
    row.error = image;
    row.error_unit = "mean FLIP over the surface";
    row.truth = fmt::format("the same moment after {} more rounds", converged_rounds);
    report.rows.push_back(row);
    const bool extreme =
        setting.relax.rounds == 1 && (setting.relax.interval == 8 || setting.series == "descent");
    if (i > 0 && !extreme) continue;
    setup.save(report, fmt::format("relaxation_{}_{}", name, i), looks.back().picture,
               fmt::format("{}: {}", name, row.setting()));
    setup.save(report, fmt::format("relaxation_{}_{}_converged", name, i), looks.back().converged,
               fmt::format("256 more rounds: FLIP {:.3f}", image));
  }
}

}  // namespace

SuiteReport measure_relaxation(const Setup& setup) {
  SuiteReport report;
  report.name = "relaxation";
  report.title = "Relaxation: mode, rounds, ε and interval";
  report.note =
      "The clip is stepped from its first frame to its deepest squeeze and looked at three times on the way. "
      "Misfit is how "
      "far the waves of neighbouring vertices are from meeting in the middle of their edge; some is left "
      "even by converged "
      "phases, since waves that fan out cannot meet everywhere. The picture's error is what more rounds "
      "would still change: "
      "it is against the same moment after 256 more. Which pattern a run ends in depends on its whole "
      "history and is no "
      "error.";
  measure_scene(setup, "sleeve", report);
  if (setup.effort == Effort::full) measure_scene(setup, "model_b", report);
  return report;
}

}  // namespace plisse::bench
