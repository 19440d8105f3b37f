// Keeps displaced cloth out of a body (--outside).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mesh/subdivide.h"
#include "pipeline/loaded_scene.h"
#include "shell/triangle_body.h"

namespace plisse::pipeline {

class Outside {
 public:
  // `body`: a mesh or material of the scene's own model, or a file of a model that is read as the scene's is
  // (unit, up axis, frames a second) and has one frame or at least the clip's; closed. Throws
  // Error(bad_input).
  Outside(const LoadedScene& scene, const std::string& body);

  // Whether it may be another in another frame while the scene's own pose stays.
  bool moves() const { return animation_ && animation_->timeline().frame_count > 1; }

  // Cuts a point's way from its base short where it would enter the body; a base that lies inside already is
  // moved only where that does not lead deeper. Points that were cut get the normals of the triangles around
  // them. Everything in model units.
  void hold(int frame, const Subdivision& mesh, DisplacedSurface& moved);

  // The same point by point. First the body as it is in a frame; `welded` begins with the places of the
  // scene's own welded vertices.
  void take(int frame, const std::vector<glm::dvec3>& welded);
  // How much of the way from a base is free, 1 where all of it is; 0 where it must not begin.
  double free_share(const glm::dvec3& base, const glm::dvec3& to) const;
  // The unit normal of the body nearest to a point, outward.
  glm::dvec3 normal_near(const glm::dvec3& x) const;
  // Whether a triangle of the scene is the body's own, which nothing holds.
  bool owns(std::size_t triangle) const;

 private:
  shell::TriangleBody body(int frame, const std::vector<glm::dvec3>& base);
  const LoadedScene& scene_;
  std::string name_;
  std::vector<std::size_t> parts_;  // of the scene's surface; or else
  io::Model model_;
  std::optional<scene::Animation> animation_;
  std::optional<shell::TriangleBody> body_;  // of the last frame
};

}  // namespace plisse::pipeline
