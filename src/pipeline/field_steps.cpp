#include "pipeline/field_steps.h"

#include <cmath>

#include "base/message_scope.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/reference_scene.h"
#include "reference/waves.h"

namespace plisse::pipeline {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr int parts = 16;          // of each edge, at whose points heights are compared
constexpr double most_work = 2e6;  // vertices times frames, about a minute

LoadedScene load(config::SceneSettings settings, const config::BiasSettings& bias) {
  settings.bias = bias;
  return LoadedScene(settings, {}, 0);  // on the model's own mesh
}

// The waves of a scene in its rest pose; after all of its frames, or at once.
class AtRest {
 public:
  AtRest(LoadedScene& scene, bool after_clip) : reference_(scene), chain_(reference_) {
    const std::vector<Eigen::Vector2d> any_sign(scene.surface().vertex_count(), Eigen::Vector2d::Zero());
    int step = 1;
    for (const int last = scene.step_of_frame(scene.animation.timeline().frame_count);
         after_clip && step <= last; ++step) {
      chain_.step(step, scene.pose(step), true, any_sign);
      scene.drop_poses_before(step);
    }
    scene::Pose rest;
    for (const glm::dvec3& x : scene.surface().rest)
      rest.cache.push_back(scene.units.world_centre + (x - scene.units.rest_centre));
    chain_.step(step, rest, true, any_sign);
    if (!scene.waves.field.empty()) scene.waves.field = scene.field_at_rest();
    profile_ = reference_profile(scene);
    triangles_ = reference_triangles(reference_, chain_.now());
    metres_ = scene.units.metres;
  }
  // Metres.
  double height(std::size_t t, const Vector3d& b) const {
    const reference::Triangle& triangle = triangles_[t];
    double height = reference::height_and_gradient(triangle.waves, b, profile_, reference::Blend::smooth,
                                                   reference::Gradient::full)
                        .height;
    if (triangle.field)
      height +=
          reference::sample(*triangle.field, triangle.waves.corners, b, reference::Blend::smooth).height;
    return metres_ * height;
  }

 private:
  ReferenceScene reference_;
  ReferenceChain chain_;
  reference::Profile profile_;
  std::vector<reference::Triangle> triangles_;
  double metres_ = 1;
};

double error_of(const Surface& surface, const AtRest& direct, const AtRest& waves) {
  double error = 0, whole = 0;
  for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
    std::array<glm::dvec3, 3> x;
    for (std::size_t c = 0; c < 3; ++c)
      x[c] = surface.rest[surface.render_vertices[surface.triangles[3 * t + c]].welded];
    const double area = glm::length(glm::cross(x[1] - x[0], x[2] - x[0]));
    // The middles of the triangle's parts² parts.
    for (int i = 0; i < parts; ++i)
      for (int j = 0; i + j < parts; ++j)
        for (int upper = 0; upper < (i + j + 1 < parts ? 2 : 1); ++upper) {
          const double third = (upper + 1) / 3.0;
          Vector3d b(0, (i + third) / parts, (j + third) / parts);
          b.x() = 1 - b.y() - b.z();
          const double wanted = direct.height(t, b), found = waves.height(t, b);
          error += area * (found - wanted) * (found - wanted);
          whole += area * wanted * wanted;
        }
  }
  return whole > 0 ? std::sqrt(error / whole) : 0;
}

}  // namespace

std::vector<FieldStep> field_steps(const config::SceneSettings& scene, const std::filesystem::path& field,
                                   const std::filesystem::path& bias_ply,
                                   const std::filesystem::path& bias_png) {
  const log::Scope unheard(log::Sink{});  // what there is to say was said when it was painted
  config::BiasSettings direct, vertices, texture;
  direct.field = field;
  direct.use = config::FieldUse::direct;
  vertices.file = bias_ply;
  texture.file = bias_png;
  LoadedScene carried = load(scene, direct);
  const AtRest wanted(carried, false);
  std::vector<FieldStep> steps;
  const auto add = [&](const char* step, LoadedScene&& with, bool after_clip) {
    steps.push_back({step, error_of(carried.surface(), wanted, AtRest(with, after_clip))});
  };
  add("vertices", load(scene, vertices), false);
  if (!bias_png.empty()) add("texture", load(scene, texture), false);
  const double work = static_cast<double>(carried.surface().vertex_count()) *
                      carried.step_of_frame(carried.animation.timeline().frame_count);
  if (work <= most_work) add("clip", load(scene, vertices), true);
  return steps;
}

}  // namespace plisse::pipeline
