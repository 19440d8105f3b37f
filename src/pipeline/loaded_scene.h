// A scene on the CPU: model, animation, surface, waves, view; and the fingerprints of its frames.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/hash.h"
#include "config/settings.h"
#include "io/import.h"
#include "mesh/model_units.h"
#include "mesh/smooth_surface.h"
#include "mesh/surface.h"
#include "mesh/vertex_waves.h"
#include "paint/canvas.h"
#include "paint/carried_field.h"
#include "paint/field.h"
#include "passes/render.h"
#include "pipeline/frame_fields.h"
#include "scene/animation.h"
#include "scene/in_memory.h"

namespace plisse::pipeline {

class LoadedScene {
 public:
  // Reads the model and prepares everything that needs no GPU. `smooth`: how often edges of surfaces with
  // fields are halved at most, to draw them smooth; 0: they are drawn as their mesh is. Throws
  // Error(bad_input).
  explicit LoadedScene(const config::SceneSettings& settings, const scene::InMemory& memory = {},
                       int smooth = most_smooth);
  // Two: where waves are longer than edges, the linear pieces left are at most a quarter of a wave.
  static constexpr int most_smooth = 2;

  config::SceneSettings settings;  // wavelength and camera resolved
  io::Model model;
  scene::Animation animation;
  RestFrames rest;
  VertexWaves waves;
  ModelUnits units;
  passes::Profile profile;

  // What is drawn: the model's own surface, or a finer one with smooth sheets in place of those with fields.
  const Surface& surface() const { return smooth_ ? smooth_->surface() : animation.surface(); }
  int smooth_levels() const { return smooth_ ? smooth_levels_ : 0; }
  double wavelength() const { return settings.wrinkles.wavelength; }
  // Camera and lights of a frame, in model units.
  passes::View view(int frame) const;
  // p of every welded vertex after these strokes (paint/canvas.h).
  paint::Painting painted(const config::PaintSettings& paint) const;

  // Whether every frame has its own field, or one that is carried is as each pose leaves it; waves.field is
  // then that of the last step, at first that of frame 1. The pose of the step must be available. Throws
  // Error(bad_input) where the field belongs to another surface than that frame's.
  bool has_field_a_frame() const { return !fields_.empty() || has_solved_waves_ || carried_; }
  void take_field(int step);
  // Whether that is one field which the pose alone decides.
  bool carries_one_field() const { return carried_.has_value(); }
  // The carried field in the rest pose, or what waves.field is.
  std::vector<FieldTriangle> field_at_rest() const {
    return carried_ ? carried_->in(surface().rest) : waves.field;
  }
  // Whether every frame has its own bias, of the base surface that is its pose; waves has that of the last
  // step that was taken, at first frame 1's. The pose of the step must be available. Gives the frames that
  // the bias is tangent to.
  bool has_bias_a_frame() const { return waves.unstrained; }
  RestFrames take_bias(int step);
  // The carried field of each frame of the clip, in one call each; no call where there is none.
  void visit_fields(const std::function<void(const std::vector<FieldTriangle>&)>& work) const;

  // History: step s (from 1) is the s-th pose of the passes; with `loop` one whole period comes first.
  int step_of_frame(int frame) const { return preroll_ + frame; }
  int frame_of_step(int step) const { return step <= preroll_ ? step : step - preroll_; }
  // How a loop closes: the phases of the drawn period's first step are stored, and in its last frames (a
  // third of the clip, at most a second) each step moves the phases toward them by this share of the
  // remaining difference; 0 elsewhere.
  bool remembers_at(int step) const { return preroll_ > 0 && step == preroll_ + 1; }
  double lead_at(int step) const;
  // The pose of a step, requested in order; a step may be requested again until a later one is dropped.
  const scene::Pose& pose(int step);
  void drop_poses_before(int step);
  // Hash of all that the state after a step depends on: settings of the passes, the surface, and every pose
  // so far.
  Hash state_hash(int step);
  // Hash of all that the frame's pixels depend on: the above, materials, camera, light, size.
  std::string frame_hash(int frame, const Hash& driver);

 private:
  struct Posed {
    scene::Pose drawn;               // of surface()
    std::vector<glm::dvec3> coarse;  // places of the model's own welded vertices, metres
  };
  void take_bias(const scene::InMemory& memory);
  void take_field(const io::WrinkleField& field, const glm::dmat4& to_world, const std::string& name);
  void take_frame_fields(FrameFields fields);
  void take_solved(const scene::InMemory& memory);
  RestFrames bias_from(int frame, const std::vector<glm::dvec3>& places);
  // The animation's pose of a frame, or what was solved in its place.
  Posed posed_at(scene::Animation& posing, int frame) const;
  std::vector<FieldTriangle> field_at(const std::vector<glm::dvec3>& coarse, int frame) const;
  // Draws these faces of the sheets smooth from here on, if they can be.
  void smooth(const SolvedClip& sheets, const std::vector<bool>& chosen);
  void smooth_all();
  // A field of the model's own surface on the one that is drawn.
  std::vector<FieldTriangle> drawn(const std::vector<glm::dvec3>& coarse, const RestFrames& frames,
                                   const paint::SurfaceField& field) const;
  std::vector<FieldTriangle> drawn_smooth(const SolvedClip::Frame& field) const;
  int smooth_levels_ = 0;
  std::optional<SmoothSurface> smooth_;
  FrameFields fields_;                          // one a frame, or none
  std::optional<paint::CarriedField> carried_;  // one field under the animation
  std::shared_ptr<const SolvedClip> solved_;
  std::vector<double> own_wavelength_;  // W where a bias of frames has none
  std::vector<double> field_mask_;      // strength of each welded vertex, of fields
  bool has_solved_waves_ = false;
  int field_frame_ = 0;
  paint::Screen screen(const config::PaintStroke& stroke) const;
  paint::SurfaceField field_of(const config::PaintStroke& stroke) const;
  void extend(int step);
  int preroll_ = 0;
  scene::Animation::Bounds bounds_;
  Hash state_base_;
  std::string constants_;    // part of every frame's hash, made at the first use
  std::deque<Posed> poses_;  // of steps first_pose_, first_pose_ + 1, …
  int first_pose_ = 1;
  std::vector<Hash> chain_;  // after each step
};

// How often edges of smooth surfaces may be halved where all edges are halved `levels` times.
int smooth_levels_within(const std::optional<int>& levels);

}  // namespace plisse::pipeline
