// The passes' memory over time on the GPU (docs/contract.md, "State over time"): steps a scene's history in
// order, so that a frame does not depend on which frames were requested.
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
  // Whether the pose of the last step was equal to the one before, bit for bit, so that nothing changed.
  bool unchanged() const { return unchanged_; }
  int unchanged_steps() const { return unchanged_steps_; }
  // Steps with crush but without a wave to relax.
  int idle_relaxations() const { return idle_relaxations_; }
  // From now on crush and relax are left out where no vertex can have a wave because of the mask. Only for
  // uses that do not need the compression, which is not computed then.
  void leave_out_masked();
  int masked_steps() const { return masked_steps_; }
  // From now on, in place of the scene's own rounds and interval: frames then depend on when this was called.
  void set_relax(const config::RelaxSettings& relax) { settings_ = relax; }
  // Whether the last step ended with a round of descent, and the change of the phases in that round (root
  // mean square over set vertices, radians). Reads them back.
  bool descended() const { return descended_; }
  double last_round_moved() const;
  // Whether crush and relax run at a step: every n-th frame of the clip.
  bool crush_runs_at(int step) const;

  // Positions, frames, waves and phases of the current step.
  passes::SurfaceBuffers& surface() { return surface_; }

  // Called within a step, after the named stage, to inspect the data between the passes. `posed`: skin is
  // done; `begun`: fresh waves of a closing loop have their phases; `led`: all other waves have, too.
  enum class Stage { posed, crushed, begun, relaxed, led };
  std::function<void(Stage)> observer;

  // Writes and reads the state as a file, with a key of everything that it depends on. Reading returns
  // whether the key agreed; if not, a warning gives the reason and nothing changes.
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
  bool field_due_ = true;  // the surface has moved since a field was carried
  bool unchanged_ = false, descended_ = false;
  int unchanged_steps_ = 0, idle_relaxations_ = 0, masked_steps_ = 0;
  bool all_masked_ = false;  // and to be left out
};

}  // namespace plisse::pipeline
