// Keeps displaced cloth outside a body (--outside).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mesh/subdivide.h"
#include "pipeline/loaded_scene.h"
#include "scene/moving_body.h"
#include "shell/triangle_body.h"

namespace plisse::pipeline {

class Outside {
 public:
  // `body`: a mesh or material of the scene's own model, or a model file, which is read with the scene's
  // options (unit, up axis, frames a second) and must have one frame or at least as many as the clip; it must
  // be closed. Throws Error(bad_input).
  Outside(const LoadedScene& scene, const std::string& body);

  // Whether the body may move while the scene's own pose does not change.
  bool moves() const { return source_.moves(); }

  // Shortens a point's displacement from its base where it would enter the body; a base that is already
  // inside is moved only where it does not get deeper. Points that were stopped get the normals of the
  // triangles around them. Everything in model units.
  void hold(int frame, const Subdivision& mesh, DisplacedSurface& moved);

  // The same for single points. First sets the body of a frame; `welded` begins with the positions of the
  // scene's own welded vertices.
  void take(int frame, const std::vector<glm::dvec3>& welded);
  // The free share of a displacement from a base, 1 if all of it is free; 0 if the point must not move.
  double free_share(const glm::dvec3& base, const glm::dvec3& to) const;
  // The unit normal of the body nearest to a point, outward.
  glm::dvec3 normal_near(const glm::dvec3& x) const;
  // Whether a triangle of the scene belongs to the body, which is not stopped.
  bool owns(std::size_t triangle) const;

 private:
  shell::TriangleBody body(int frame, const std::vector<glm::dvec3>& base);
  const LoadedScene& scene_;
  std::string name_;
  scene::MovingBody source_;
  std::optional<shell::TriangleBody> body_;  // of the last frame
};

}  // namespace plisse::pipeline
