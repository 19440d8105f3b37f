#include "cloth/drape_obstacles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "base/eigen_glm.h"
#include "io/import.h"
#include "scene/animation.h"

namespace plisse::cloth {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// A model's welded surface at any moment between its frames.
class MovingModel {
 public:
  MovingModel(const config::DrapeSettings::Obstacle& obstacle)
      : name_(obstacle.file.string()),
        animation_(io::import_model(obstacle.file), scene::AnimationChoice{.clip = obstacle.clip}) {
    const Surface& surface = animation_.surface();
    for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
      TriangleTree::Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k)
        triangle[k] = surface.render_vertices[surface.triangles[3 * t + k]].welded;
      if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
        triangles_.push_back(triangle);
    }
  }

  bool moves() const { return animation_.timeline().frame_count > 1; }

  shell::Body body(double frame, const Isometry3d& motion) {
    const double within = std::clamp(frame, 1.0, static_cast<double>(animation_.timeline().frame_count));
    const int before = static_cast<int>(std::floor(within)), after = static_cast<int>(std::ceil(within));
    Matrix3Xd points = points_at(before);
    if (after != before) points += (within - before) * (points_at(after) - points);
    return std::make_shared<shell::TriangleBody>(motion * points, triangles_, name_);
  }

 private:
  Matrix3Xd points_at(int frame) {
    return points_to_eigen(scene::posed(animation_.surface(), animation_.pose(frame)));
  }

  std::string name_;
  scene::Animation animation_;
  std::vector<TriangleTree::Triangle> triangles_;
};

struct Placed {
  config::DrapeSettings::Obstacle settings;
  std::shared_ptr<MovingModel> model;  // of a kind that is made of a file

  bool moves() const {
    return settings.motion.turn != 0 || settings.motion.move != glm::dvec3(0) || (model && model->moves());
  }

  shell::Obstacle at(double t, int frames) const {
    const Isometry3d motion = motion_at(settings.motion, t);
    if (model) return model->body(1 + t * (frames - 1), motion);
    shell::SolidShape now = settings.shape;
    now.at = motion * now.at;
    now.to = motion * now.to;
    now.normal = motion.linear() * now.normal;
    return settings.kind->make(now);
  }
};

}  // namespace

Isometry3d motion_at(const config::DrapeSettings::Motion& motion, double t) {
  const Vector3d point = to_eigen(motion.point);
  Isometry3d result = Isometry3d::Identity();
  result.translate(point + t * to_eigen(motion.move));
  result.rotate(Eigen::AngleAxisd(t * motion.turn * std::numbers::pi / 180, to_eigen(motion.axis)));
  result.translate(-point);
  return result;
}

void place_obstacles(const config::DrapeSettings& settings, DrapeScene& scene) {
  std::vector<Placed> all;
  bool moves = false;
  for (const auto& obstacle : settings.obstacles) {
    Placed& placed = all.emplace_back(Placed{obstacle, nullptr});
    if (!obstacle.kind->make) placed.model = std::make_shared<MovingModel>(obstacle);
    moves = moves || placed.moves();
  }
  for (const Placed& placed : all) scene.loads.obstacles.push_back(placed.at(0, scene.frames));
  if (!moves) return;
  scene.obstacles = [all, frames = scene.frames, start = scene.loads.obstacles](double t) {
    std::vector<shell::Obstacle> now = start;
    for (std::size_t o = 0; o < all.size(); ++o)
      if (all[o].moves()) now[o] = all[o].at(t, frames);
    return now;
  };
}

}  // namespace plisse::cloth
