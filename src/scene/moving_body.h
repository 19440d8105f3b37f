// A body that cloth is to stay outside of, over the frames of a scene: a mesh or material of the scene's own
// model, or a model of its own.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "config/settings.h"
#include "io/model.h"
#include "scene/animation.h"

namespace plisse::scene {

class MovingBody {
 public:
  // `name`: a mesh or material of `surface`; or a model's file, which is read with the scene's options (unit,
  // up axis, frames a second) and must have one frame or at least as many as the clip. `option`: what named
  // it, for messages. Throws Error(bad_input).
  MovingBody(const config::SceneSettings& scene, const Surface& surface, const Timeline& clip,
             const std::string& name, const std::string& option);

  bool own() const { return !animation_; }  // of the scene's own model
  bool moves() const { return animation_ && animation_->timeline().frame_count > 1; }
  const std::vector<std::size_t>& parts() const { return parts_; }  // of the surface; none: a file's

  struct Triangles {
    std::vector<glm::dvec3> places;
    std::vector<std::array<std::uint32_t, 3>> triangles;
  };
  // In a frame: of the scene's own model out of `welded`, which begins with the places of `surface`'s welded
  // vertices in any unit; else in metres.
  Triangles at(int frame, const Surface& surface, const std::vector<glm::dvec3>& welded);

 private:
  std::string name_;
  std::vector<std::size_t> parts_;
  io::Model model_;
  std::optional<Animation> animation_;
};

}  // namespace plisse::scene
