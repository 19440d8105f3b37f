// Compares shader and reference, pass by pass: each pass of the reference has the same input as the GPU's
// pass, so that the error of one does not count in the next (docs/contract.md, "State over time", rule 6).
// The error of all passes together is reported separately.
#include "pipeline/verify.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/interrupt.h"
#include "config/frames.h"
#include "config/settings.h"
#include "pipeline/render.h"
#include "pipeline/stepper.h"
#include "pipeline/verify_displacement.h"
#include "pipeline/verify_pictures.h"
#include "pipeline/verify_waves.h"

namespace plisse::pipeline {
namespace {

constexpr double flip_tolerance = 0.02;
// Errors of the passes, each within its own tolerance, accumulate over frames, but relaxation brings phases
// together again: the sum stays near 1e-4. Only where a threshold is decided differently has a vertex another
// phase, by up to π: four such vertices in a thousand give .2. A step that is left out, or a sign that is
// wrong in every frame, gives a radian and more at all vertices.
constexpr double chain_tolerance = 0.2;  // rad, root mean square
// At least half of the visible pixels must be compared. The silhouette is about 4/n of an object that is n
// pixels wide.
constexpr double silhouette_limit = 0.5;
constexpr int largest_side = 640;  // of the pictures compared: the reference is too slow for 4k

config::SceneSettings small(config::SceneSettings settings) {
  auto& output = settings.output;
  const double scale =
      static_cast<double>(largest_side) / std::max({output.width, output.height, largest_side});
  output.width = std::max(1, static_cast<int>(output.width * scale));
  output.height = std::max(1, static_cast<int>(output.height * scale));
  return settings;
}

class Verifier {
 public:
  explicit Verifier(const RenderRequest& request)
      : scene_(small(request.scene), request.memory),
        reference_(scene_),
        context_(request.device),
        timer_(context_.info().software),
        stepper_(scene_, timer_, request.shader_folder),
        waves_(scene_, reference_, stepper_, request.shader_folder),
        displacement_(scene_, request.shader_folder),
        pictures_(scene_, reference_, request.shader_folder) {}

  VerifyReport run(const FrameCallback& on_frame) {
    VerifyReport report;
    report.gl = context_.info();
    const std::vector<int> wanted = picked();
    stepper_.observer = [this](pipeline::Stepper::Stage stage) { waves_.observe(stage); };
    const int last = scene_.step_of_frame(wanted.back());
    for (int step = 1; step <= last; ++step) {
      const int frame = scene_.frame_of_step(step);
      const bool looking =
          step == scene_.step_of_frame(frame) && std::binary_search(wanted.begin(), wanted.end(), frame);
      waves_.before_step(step, looking);
      if (!stepper_.advance_to(step)) {
        report.interrupted = true;
        break;
      }
      waves_.after_step(step);
      if (!looking) continue;
      const auto gpu = pipeline::read_snapshot(stepper_.surface());
      displacement_.compare(stepper_.surface(), gpu);
      pictures_.compare(frame, stepper_.surface(), gpu, waves_.chain());
      report.chain_phase_rms = std::max(report.chain_phase_rms, waves_.chain_phase_difference(gpu));
      report.frames.push_back(frame);
      FrameReport entry;
      entry.frame = frame;
      entry.time_s = scene_.animation.timeline().time(frame);
      if (on_frame) on_frame(static_cast<int>(report.frames.size()), static_cast<int>(wanted.size()), entry);
    }
    finish(report);
    return report;
  }

 private:
  std::vector<int> picked() const {
    const int count = scene_.animation.timeline().frame_count;
    if (!scene_.settings.model.frames.empty())
      return config::select_frames(scene_.settings.model.frames, count);
    std::vector<int> frames;
    const int wanted = std::min(8, count);
    for (int i = 0; i < wanted; ++i) frames.push_back(1 + (wanted > 1 ? i * (count - 1) / (wanted - 1) : 0));
    return frames;
  }

  void finish(VerifyReport& report) const {
    waves_.report(report.passes);
    displacement_.report(report.passes);
    pictures_.report(report.passes);
    report.fraction_within_4 = pictures_.image().within();
    report.mean_flip = pictures_.mean_flip();
    report.silhouette_fraction = pictures_.silhouette_fraction();
    report.chain_image_flip = pictures_.chain_flip();
    report.chain_phase_tolerance = chain_tolerance;
    report.chain_flip_tolerance = flip_tolerance;
    const auto fail = [&](std::string sentence) { report.failures.push_back(std::move(sentence)); };
    for (const auto& [name, pass] : report.passes) {
      if (pass.ok) continue;
      fail(fmt::format("{}: {:.3g} % of {} values within {:.3g} {}, {:.6g} % wanted; largest error {:.3g}",
                       name, 100 * pass.within, pass.compared, pass.tolerance, pass.unit, 100 * pass.fraction,
                       pass.max_abs));
    }
    const auto fail_render = [&](std::string sentence) {
      fail(std::move(sentence));
      report.passes["render"].ok = false;
    };
    if (report.mean_flip > flip_tolerance) {
      fail_render(fmt::format("render: mean FLIP {:.4f}, tolerance {}", report.mean_flip, flip_tolerance));
    }
    if (report.silhouette_fraction > silhouette_limit) {
      fail_render(
          fmt::format("render: {:.3g} % of the surface's pixels are silhouettes, which are not compared; at "
                      "most {:.3g} % may be: "
                      "a larger --size, up to {} pixels a side, or a closer --camera leaves fewer",
                      100 * report.silhouette_fraction, 100 * silhouette_limit, largest_side));
    } else if (pictures_.image().count() == 0 && !report.frames.empty()) {
      fail_render(fmt::format("render: nothing in view to compare: no pixel of frame{} {} shows the model",
                              report.frames.size() == 1 ? "" : "s", fmt::join(report.frames, ", ")));
    }
    // A pass is right where all its parts are.
    for (const auto& [name, part] : report.passes) {
      if (!part.ok) report.passes[name.substr(0, name.find('.'))].ok = false;
    }
    if (report.chain_phase_rms > chain_tolerance) {
      fail(fmt::format("chain: phases drift apart by {:.3g} rad (root mean square), tolerance {}",
                       report.chain_phase_rms, chain_tolerance));
    }
    if (report.chain_image_flip > flip_tolerance) {
      fail(fmt::format("chain: mean FLIP {:.4f}, tolerance {}", report.chain_image_flip, flip_tolerance));
    }
    report.chain_ok = report.chain_phase_rms <= chain_tolerance && report.chain_image_flip <= flip_tolerance;
    report.ok = report.failures.empty() && !report.interrupted;
  }

  pipeline::LoadedScene scene_;
  pipeline::ReferenceScene reference_;
  gpu::Context context_;
  gpu::StageTimer timer_;
  pipeline::Stepper stepper_;
  pipeline::WaveComparison waves_;
  pipeline::DisplacementComparison displacement_;
  pipeline::PictureComparison pictures_;
};

}  // namespace

VerifyReport verify(const RenderRequest& request, const FrameCallback& on_frame) {
  return Verifier(request).run(on_frame);
}

}  // namespace plisse::pipeline
