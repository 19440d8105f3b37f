// The camera that is fitted round a model: every point is in the picture, and the picture is as full as can
// be.
#include "scene/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scene/animation.h"

namespace plisse::scene {
namespace {

struct Cloud {
  std::vector<glm::dvec3> points;
  Animation::Bounds bounds{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
};

// Points in a box of this size (metres) that is far from the origin.
Cloud cloud(const glm::dvec3& size, unsigned seed) {
  std::mt19937 random(seed);
  Cloud cloud;
  for (int i = 0; i < 200; ++i) {
    glm::dvec3 x(3, -2, 7);
    for (int c = 0; c < 3; ++c) x[c] += size[c] * static_cast<double>(random()) / 4294967295.0;
    cloud.points.push_back(x);
    cloud.bounds.low = glm::min(cloud.bounds.low, x);
    cloud.bounds.high = glm::max(cloud.bounds.high, x);
  }
  return cloud;
}

config::SceneSettings picture(int width, int height) {
  config::SceneSettings settings;
  settings.output.width = width;
  settings.output.height = height;
  return settings;
}

struct Extent {
  double left = INFINITY, right = -INFINITY, bottom = INFINITY, top = -INFINITY;
};

// How far the points reach over a film of 36 mm along the picture's longer side: −1 … 1 is all of it.
Extent extent(const config::SceneSettings& settings, const config::CameraSettings& camera,
              const Cloud& cloud) {
  const glm::dvec3 forward = glm::normalize(camera.target - camera.eye),
                   right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0))),
                   high = glm::cross(right, forward);
  const double longer = std::max(settings.output.width, settings.output.height);
  const double millimetres = 36 / longer;  // a pixel
  const double half_width = settings.output.width * millimetres / 2,
               half_height = settings.output.height * millimetres / 2;
  Extent extent;
  for (const glm::dvec3& x : cloud.points) {
    const glm::dvec3 d = x - camera.eye;
    const double depth = glm::dot(d, forward);
    EXPECT_GT(depth, 0) << "a point behind the camera";
    const double across = camera.focal_length * glm::dot(d, right) / depth / half_width;
    const double upward = camera.focal_length * glm::dot(d, high) / depth / half_height;
    extent.left = std::min(extent.left, across);
    extent.right = std::max(extent.right, across);
    extent.bottom = std::min(extent.bottom, upward);
    extent.top = std::max(extent.top, upward);
  }
  return extent;
}

// All of the points and a margin of 1.08, and no more than that: in one direction they touch both edges of
// what is left.
TEST(FittedCamera, HoldsEveryPointAndNoMore) {
  unsigned seed = 1;
  for (const auto& [width, height] : {std::pair(1280, 1024), {320, 960}, {500, 500}}) {
    for (const glm::dvec3& size :
         {glm::dvec3(1, 1, 1), {5, 0.5, 1}, {0.2, 6, 0.3}, {2, 0.01, 2}, {1e-3, 1e-3, 4e-3}}) {
      for (const double azimuth : {0.0, 35.0, -120.0}) {
        config::SceneSettings settings = picture(width, height);
        settings.camera.azimuth = azimuth;
        settings.camera.focal_length = 30 + 10 * (seed % 5);
        const Cloud points = cloud(size, seed++);
        const auto camera = fitted_camera(settings, points.bounds, points.points);
        ASSERT_TRUE(camera.explicit_pose);
        const Extent seen = extent(settings, camera, points);
        // Doubles at a distance of about 10 m of millimetres: 1e-15 · 1e4, with room.
        const double edge = 1 / 1.08, rounding = 1e-10;
        EXPECT_LE(std::max({-seen.left, seen.right, -seen.bottom, seen.top}), edge + rounding);
        const double across = std::min(-seen.left, seen.right), upward = std::min(-seen.bottom, seen.top);
        EXPECT_NEAR(std::max(across, upward), edge, rounding)
            << width << " × " << height << ", seed " << seed;
      }
    }
  }
}

TEST(FittedCamera, LooksFromItsAzimuthAndElevation) {
  const Cloud points = cloud({1, 1, 1}, 1);
  config::SceneSettings settings = picture(400, 300);
  settings.camera.azimuth = 30;
  settings.camera.elevation = 20;
  const auto toward = [&](const config::CameraSettings& camera) {
    return glm::normalize(camera.eye - camera.target);
  };
  const auto camera = fitted_camera(settings, points.bounds, points.points);
  // At azimuth 0 the camera stands at +z, at 90° it stands at +x.
  const glm::dvec3 expected(std::sin(glm::radians(30.0)) * std::cos(glm::radians(20.0)),
                            std::sin(glm::radians(20.0)),
                            std::cos(glm::radians(30.0)) * std::cos(glm::radians(20.0)));
  EXPECT_NEAR(glm::distance(toward(camera), expected), 0, 1e-12);
  settings.camera.distance = 4;
  const auto given = fitted_camera(settings, points.bounds, points.points);
  EXPECT_NEAR(glm::distance(given.eye, given.target), 4, 1e-12);
  EXPECT_NEAR(glm::distance(given.target, camera.target), 0, 1e-12);
}

TEST(FittedCamera, LeavesACameraThatWasChosenAlone) {
  const Cloud points = cloud({1, 1, 1}, 1);
  config::SceneSettings settings = picture(400, 300);
  settings.camera.name = "front";
  EXPECT_FALSE(fitted_camera(settings, points.bounds, points.points).explicit_pose);
  settings.camera.name.clear();
  settings.camera.explicit_pose = true;
  settings.camera.eye = {1, 2, 3};
  EXPECT_EQ(fitted_camera(settings, points.bounds, points.points).eye, glm::dvec3(1, 2, 3));
}

// Upright things from 15°; a sheet on the ground from 50°; between, in proportion to the height over 0.3 of
// the narrower side.
TEST(FittedCamera, LooksDownOnWhatLiesFlat) {
  const auto elevation_over = [](double height) {
    Cloud box;
    box.bounds = {{-1, 0, -0.5}, {1, height, 0.5}};
    for (const double y : {0.0, height}) {
      for (const double x : {-1.0, 1.0})
        for (const double z : {-0.5, 0.5}) box.points.emplace_back(x, y, z);
    }
    const auto camera = fitted_camera(picture(400, 300), box.bounds, box.points);
    return glm::degrees(std::asin(glm::normalize(camera.eye - camera.target).y));
  };
  // asin of numbers below 0.8: a few roundings, in degrees.
  EXPECT_NEAR(elevation_over(2), 15, 1e-9);
  EXPECT_NEAR(elevation_over(0.3), 15, 1e-9);
  EXPECT_NEAR(elevation_over(0.15), 32.5, 1e-9);
  EXPECT_NEAR(elevation_over(0), 50, 1e-9);
}

// A triangle, posed by nothing, in units that are not metres.
struct Posed {
  Posed() {
    io::Mesh mesh;
    mesh.positions = {{-1, 0, 0}, {1, 0, 0}, {0, 3, 0}};
    mesh.triangles = {0, 1, 2};
    mesh.normals.assign(3, {0, 0, 1});
    model.path = "made by hand";
    model.nodes.resize(2);
    model.nodes[0].name = "root";
    model.nodes[0].meshes = {0};
    model.meshes.push_back(std::move(mesh));
  }
  io::Model model;
};

// Where the camera of a frame puts a point: −1 … 1 across the picture, and the depth.
glm::dvec3 put(const Camera& camera, const ModelUnits& units, const glm::dvec3& x) {
  const glm::dvec4 clip = camera.view_projection * glm::dvec4(units.world(x), 1.0);
  return glm::dvec3(clip) / clip.w;
}

TEST(CameraOfAFrame, PutsPointsWhereThePinholeDoes) {
  const Posed posed;
  const Animation animation(posed.model, {});
  config::SceneSettings settings = picture(400, 300);
  settings.camera.explicit_pose = true;
  settings.camera.focal_length = 36;  // half the film is half the distance wide
  settings.camera.eye = {0, 1, 8};
  settings.camera.target = {0, 1, 0};
  const ModelUnits units{4, {}, {0, 1.5, 0}};
  const Animation::Bounds bounds{{-1, 0, 0}, {1, 3, 0}};
  const Camera camera = camera_at(settings, posed.model, animation, 1, bounds, units);
  // Doubles through a few matrix products.
  const double rounding = 1e-12;
  EXPECT_NEAR(glm::distance(glm::dvec2(put(camera, units, {1, 1, 0})), {0.25, 0}), 0, rounding);
  EXPECT_NEAR(glm::distance(glm::dvec2(put(camera, units, {0, 2.5, 0})), {0, 0.5}), 0, rounding);
  EXPECT_NEAR(glm::distance(camera.eye, units.world({0, 1, 8})), 0, rounding);
  EXPECT_NEAR(glm::distance(camera.forward, {0, 0, -1}), 0, rounding);
  EXPECT_NEAR(camera.floor, units.world({0, 0, 0}).y, rounding);
  EXPECT_NEAR(camera.bounds_radius, std::sqrt(13.0) / 2 / 4, rounding);
  // Near and far planes leave the model's sphere alone.
  for (const double z : {-1.8, 1.8}) EXPECT_LT(std::abs(put(camera, units, {0, 1.5, z}).z), 1);
}

TEST(CameraOfAFrame, IsThatOfTheModelByNameOrIndex) {
  Posed posed;
  posed.model.nodes[1].name = "stand";
  posed.model.nodes[1].local[3] = glm::dvec4(0, 1, 5, 1);
  io::Camera perspective;
  perspective.name = "front";
  perspective.node = 1;
  perspective.vertical_field_of_view = 2 * std::atan(0.5);
  io::Camera parallel = perspective;
  parallel.name = "plan";
  parallel.half_height = 2;
  posed.model.cameras = {perspective, parallel};
  const Animation animation(posed.model, {});
  const Animation::Bounds bounds{{-1, 0, 0}, {1, 3, 0}};
  const ModelUnits units{4, {}, {0, 1.5, 0}};
  config::SceneSettings settings = picture(400, 200);
  for (const char* choice : {"front", "0"}) {
    settings.camera.name = choice;
    const Camera camera = camera_at(settings, posed.model, animation, 1, bounds, units);
    // Half the height is 2.5 at the triangle, half the width twice that.
    EXPECT_NEAR(glm::distance(glm::dvec2(put(camera, units, {1, 2.25, 0})), {0.2, 0.5}), 0, 1e-12) << choice;
  }
  settings.camera.name = "plan";
  const Camera camera = camera_at(settings, posed.model, animation, 1, bounds, units);
  for (const double z : {0.0, -1.0})
    EXPECT_NEAR(glm::distance(glm::dvec2(put(camera, units, {1, 2, z})), {0.25, 0.5}), 0, 1e-9) << z;
}

}  // namespace
}  // namespace plisse::scene
