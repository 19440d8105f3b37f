// A scene on the CPU: model, animation, surface, waves, view; and the fingerprints that name its frames.
#pragma once

#include <deque>
#include <vector>

#include "base/hash.h"
#include "config/settings.h"
#include "io/import.h"
#include "mesh/surface.h"
#include "mesh/vertex_waves.h"
#include "paint/canvas.h"
#include "passes/model_units.h"
#include "passes/render.h"
#include "scene/animation.h"

namespace plisse::pipeline {

class LoadedScene {
 public:
  // Reads the model and prepares everything that needs no GPU. Throws Error(bad_input).
  explicit LoadedScene(const SceneSettings& settings);

  SceneSettings settings;  // wavelength and camera resolved
  io::Model model;
  Animation animation;
  RestFrames rest;
  VertexWaves waves;
  passes::ModelUnits units;
  passes::Profile profile;

  const Surface& surface() const { return animation.surface(); }
  double wavelength() const { return settings.wrinkles.wavelength; }
  passes::Look look() const;
  std::vector<passes::DrawPart> draw_parts() const;
  std::vector<std::vector<passes::TextureLevel>> texture_levels() const;
  passes::View view(int frame) const { return view(frame, settings); }
  // p of every welded vertex after these strokes (paint/canvas.h).
  std::vector<glm::dvec3> painted(const PaintSettings& paint) const;

  // History: step s (from 1) is the s-th pose that the passes see; with `loop` one whole period comes first.
  int step_of_frame(int frame) const { return preroll_ + frame; }
  int frame_of_step(int step) const { return step <= preroll_ ? step : step - preroll_; }
  // How a loop closes: the phases of the drawn period's first step are remembered, and in its last frames (a
  // third of the clip, at most a second) each step moves this share of what is left toward them; 0 elsewhere.
  bool remembers_at(int step) const { return preroll_ > 0 && step == preroll_ + 1; }
  double lead_at(int step) const;
  // The pose of a step, asked in order; a step may be asked again until a later one is dropped.
  const Pose& pose(int step);
  void drop_poses_before(int step);
  // Decides the state after a step: settings of the passes, the surface, and every pose so far.
  Hash state_hash(int step);
  // Decides the frame's pixels: the above, materials, camera, light, size.
  std::string frame_hash(int frame, const Hash& driver);

 private:
  void take_bias();
  paint::Screen screen(const PaintStroke& stroke) const;
  CameraSettings fitted_camera(const SceneSettings& given, const std::vector<glm::dvec3>& samples) const;
  passes::View view(int frame, const SceneSettings& given) const;
  void extend(int step);
  Hash constants_hash() const;
  int preroll_ = 0;
  Animation::Bounds bounds_;
  Hash state_base_;
  std::string constants_;   // of the hash of a frame, once one was asked for
  std::deque<Pose> poses_;  // of steps first_pose_, first_pose_ + 1, …
  int first_pose_ = 1;
  std::vector<Hash> chain_;  // after each step
};

}  // namespace plisse::pipeline
