// Sampling against values worked out by hand.
#include "scene/sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plisse {
namespace {

constexpr double pi = std::numbers::pi;
// Values are sums of a few products of numbers near 1; a dozen units in the last place.
constexpr double rounding = 1e-14;

io::Keys<glm::dvec3> ramp(io::Interpolation interpolation) {
  io::Keys<glm::dvec3> keys;
  keys.interpolation = interpolation;
  keys.times = {1, 3};
  keys.values = {{0, 0, 0}, {4, 0, 8}};
  return keys;
}

glm::dquat about_z(double angle) {
  return {std::cos(angle / 2), 0, 0, std::sin(angle / 2)};
}

double difference(const glm::dquat& a, const glm::dquat& b) {
  return glm::length(a - b);
}

TEST(Sample, LinearBetweenKeysAndHeldOutside) {
  const auto keys = ramp(io::Interpolation::linear);
  EXPECT_EQ(scene::sample(keys, 0), glm::dvec3(0, 0, 0));
  EXPECT_EQ(scene::sample(keys, 1.5), glm::dvec3(1, 0, 2));
  EXPECT_EQ(scene::sample(keys, 3), glm::dvec3(4, 0, 8));
  EXPECT_EQ(scene::sample(keys, 99), glm::dvec3(4, 0, 8));
}

TEST(Sample, StepHoldsTheKeyBefore) {
  const auto keys = ramp(io::Interpolation::step);
  EXPECT_EQ(scene::sample(keys, 2.999), glm::dvec3(0, 0, 0));
  EXPECT_EQ(scene::sample(keys, 3), glm::dvec3(4, 0, 8));
}

TEST(Sample, CubicSplineOfGltf) {
  auto keys = ramp(io::Interpolation::cubic_spline);
  keys.in_tangents = {{0, 0, 0}, {-1, 0, 0}};
  keys.out_tangents = {{3, 1, 0}, {0, 0, 0}};
  // s = ½, d = 2: weights ½, d/8, ½, −d/8. x = 0 + ¼·3 + ½·4 − ¼·(−1) = 3, y = ¼·1, z = ½·8.
  EXPECT_NEAR(glm::distance(scene::sample(keys, 2), {3, 0.25, 4}), 0, rounding);
  EXPECT_EQ(scene::sample(keys, 1), glm::dvec3(0, 0, 0));
  EXPECT_EQ(scene::sample(keys, 3), glm::dvec3(4, 0, 8));
  // The slope at the first key is its out-tangent per second: a forward difference with an error of O(step).
  const glm::dvec3 slope = (scene::sample(keys, 1 + 1e-6) - scene::sample(keys, 1)) / 1e-6;
  EXPECT_NEAR(slope.x, 3, 1e-4);
  EXPECT_NEAR(slope.y, 1, 1e-4);
}

TEST(Sample, RotationsGoRoundTheShorterWay) {
  io::Keys<glm::dquat> keys;
  keys.times = {0, 1};
  keys.values = {about_z(0), about_z(pi / 2)};
  EXPECT_NEAR(difference(scene::sample(keys, 1.0 / 3), about_z(pi / 6)), 0, rounding);
  // The same rotation written with the other sign is no detour.
  keys.values[1] = -keys.values[1];
  EXPECT_NEAR(difference(scene::sample(keys, 1.0 / 3), about_z(pi / 6)), 0, rounding);
}

TEST(Sample, RotationsOutOfTheFileAreMadeUnit) {
  io::Keys<glm::dquat> keys;
  keys.times = {0};
  keys.values = {about_z(1) * 3.0};
  EXPECT_NEAR(difference(scene::sample(keys, 0), about_z(1)), 0, rounding);
}

TEST(Sample, CubicRotationIsNormalised) {
  io::Keys<glm::dquat> keys;
  keys.interpolation = io::Interpolation::cubic_spline;
  keys.times = {0, 1};
  keys.values = {about_z(0), about_z(pi / 2)};
  keys.in_tangents.assign(2, glm::dquat(0, 0, 0, 0));
  keys.out_tangents = keys.in_tangents;
  // Half of each key, normalised: by symmetry the rotation half way.
  EXPECT_NEAR(difference(scene::sample(keys, 0.5), about_z(pi / 4)), 0, rounding);
}

TEST(Sample, MorphWeights) {
  io::Keys<std::vector<double>> keys;
  keys.times = {0, 2};
  keys.values = {{0, 1}, {1, 0}};
  EXPECT_EQ(scene::sample(keys, 0.5), (std::vector<double>{0.25, 0.75}));
  keys.interpolation = io::Interpolation::cubic_spline;
  keys.in_tangents = {{0, 0}, {2, 0}};
  keys.out_tangents = {{0, 0}, {0, 0}};
  // s = ½, d = 2: ½·1 − ¼·2 = 0 for the first, ½·1 for the second.
  EXPECT_EQ(scene::sample(keys, 1), (std::vector<double>{0, 0.5}));
}

}  // namespace
}  // namespace plisse
