// The passes' memory over time on the GPU (docs/contract.md, "State over time"): steps a scene's history in
// order, so that a frame does not depend on which frames were asked for.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "gpu/timer.h"
#include "passes/crush.h"
#include "passes/relax.h"
#include "passes/skin.h"
#include "passes/surface_buffers.h"
#include "pipeline/loaded_scene.h"

namespace plisse::pipeline {

passes::RelaxOptions relax_options(const config::RelaxSettings& settings);

class Stepper {
 public:
  // Needs a current OpenGL context.
  Stepper(LoadedScene& scene, gpu::StageTimer& timer, const std::string& shader_folder);

  // Steps on until the state is that of `step` (LoadedScene::step_of_frame); never backward.
  // Stops between two steps where the run is interrupted (base/interrupt.h), and returns false.
  bool advance_to(int step);
  int step() const { return step_; }
  // Whether the last step found the pose of the one before, bit for bit, and left everything as it was.
  bool unchanged() const { return unchanged_; }
  int unchanged_steps() const { return unchanged_steps_; }
  // Steps that were crushed and had no wave to relax.
  int idle_relaxations() const { return idle_relaxations_; }
  // From now on crush and relax are left out where the mask leaves no vertex a wave: for who looks at nothing
  // but heights, since the compression is not found then.
  void leave_out_masked();
  int masked_steps() const { return masked_steps_; }
  // From now on, in place of the scene's own rounds and interval: frames then depend on when this was called.
  void set_relax(const config::RelaxSettings& relax) { settings_ = relax; }
  // Whether the last step ended with a round of descent; and by what (root mean square over set vertices,
  // radians) that moved the phases. Reads them back.
  bool descended() const { return descended_; }
  double last_round_moved() const;
  // Whether crush and relax run at a step: every n-th frame of the clip.
  bool crush_runs_at(int step) const;

  // Positions, frames, waves and phases of the current step.
  passes::SurfaceBuffers& surface() { return surface_; }

  // Called inside a step, after the stage named, for who wants to look between the passes. `posed`: skin is
  // done; `begun`: fresh waves of a closing loop have their phases; `led`: so have all of its others.
  enum class Stage { posed, crushed, begun, relaxed, led };
  std::function<void(Stage)> observer;

  // The state under a name, keyed by everything that led to it. Reading returns whether it fitted; if not, a
  // warning says why and nothing changed.
  void write_state(const std::filesystem::path& path, const Hash& driver);
  bool read_state(const std::filesystem::path& path, const Hash& driver, int last_usable_step);

 private:
  void skin(const scene::Pose& pose);
  void crush();
  void relax();
  void observe(Stage stage) const;
  LoadedScene& scene_;
  config::RelaxSettings settings_;
  gpu::StageTimer& timer_;
  passes::SurfaceBuffers surface_;
  passes::SkinPass skin_;
  passes::CrushPass crush_;
  passes::RelaxPass relax_;
  gpu::Buffer remembered_phases_,
      remembered_states_;  // of the drawn period's first step, where a loop has to close
  int step_ = 0;
  std::optional<scene::Pose> last_pose_, crushed_pose_;
  bool unchanged_ = false, descended_ = false;
  int unchanged_steps_ = 0, idle_relaxations_ = 0, masked_steps_ = 0;
  bool all_masked_ = false;  // and to be left out
};

}  // namespace plisse::pipeline
