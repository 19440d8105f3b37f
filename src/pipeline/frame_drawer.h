// Steps a scene to a frame and draws it: all of a run that needs OpenGL. Work that changes nothing visible is
// left out and counted.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/context.h"
#include "gpu/target.h"
#include "passes/displacement.h"
#include "passes/render.h"
#include "pipeline/aov.h"
#include "pipeline/displace.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/outside.h"
#include "pipeline/picture.h"
#include "pipeline/render.h"
#include "pipeline/stepper.h"

namespace plisse::pipeline {

class FrameDrawer {
 public:
  // Needs a current context. `aovs`: what request.aovs names.
  // `split`: of the scene's surface, where it is displaced.
  FrameDrawer(LoadedScene& scene, const RenderRequest& request, std::optional<Subdivision> split,
              const std::vector<passes::Aov>& aovs, const gpu::Context& context, gpu::StageTimer& timer);

  Stepper& stepper() { return stepper_; }
  void set_effort(const Effort& effort);
  // Steps to a frame, with all frames in between; false where the run was interrupted.
  bool advance_to(int frame);
  // Draws the current frame; AOVs are written beside `entry.path`. Adds the stages' milliseconds.
  std::shared_ptr<Picture> draw(FrameReport& entry, const std::string& hash);

  // The kinds of work that were left out, and how often.
  std::map<std::string, int> skipped() const;

 private:
  // Waves as geometry for the render pass: displaced on the GPU, or on the CPU if there is a body.
  struct Geometry {
    Geometry(const LoadedScene& scene, Subdivision split, const RenderRequest& request);
    void move(const passes::SurfaceBuffers& posed, int frame);
    Subdivision mesh;
    passes::SurfaceBuffers buffers;
    passes::DisplacementPass pass;
    struct Held {
      Held(const LoadedScene& scene, const Subdivision& mesh, const std::string& body)
          : displacement(scene, mesh), outside(scene, body) {}
      Displacement displacement;
      Outside outside;
    };
    std::optional<Held> held;
  };
  std::vector<passes::DrawPart> parts() const;
  const passes::SurfaceBuffers& drawn() { return geometry_ ? geometry_->buffers : stepper_.surface(); }
  const gpu::Target& target();

  LoadedScene& scene_;
  const RenderRequest& request_;
  bool software_;
  gpu::StageTimer& timer_;
  Stepper stepper_;
  std::optional<Geometry> geometry_;
  passes::RenderPass pass_;
  std::map<int, gpu::Target> targets_;  // by samples
  int samples_;
  std::optional<AovWriter> aov_writer_;
  std::shared_ptr<Picture> picture_;  // of the step before, for poses that do not change
  int picture_step_ = 0, frame_ = 0;
  bool stays_ = false;
  int copied_ = 0, out_of_view_ = 0;
  int parts_out_of_view_ = 0, flat_parts_ = 0, fine_parts_ = 0,
      untextured_parts_ = 0;  // in all frames together
};

}  // namespace plisse::pipeline
