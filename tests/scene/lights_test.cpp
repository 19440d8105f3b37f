// On which side of the view each light stands: directions in closed form.
#include "scene/lights.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plisse::scene {
namespace {

// Sines and cosines of round angles, a few products.
constexpr double rounding = 1e-14;

const glm::dvec3 up(0, 1, 0);

// Where the key light stands for a camera that looks along `forward`.
glm::dvec3 key_from(double azimuth, double elevation, const glm::dvec3& forward = {0, 0, -1}) {
  config::LightSettings settings;
  settings.key_azimuth = azimuth;
  settings.key_elevation = elevation;
  return lights_for(settings, forward, up).directional[0].direction;
}

void expect_at(const glm::dvec3& direction, const glm::dvec3& expected) {
  EXPECT_NEAR(glm::distance(direction, expected), 0, rounding)
      << direction.x << ' ' << direction.y << ' ' << direction.z;
}

// A camera that looks along −z sees +x on its right and has +z behind it.
TEST(Lights, AzimuthsGoFromBehindTheCameraToTheRightOfTheView) {
  expect_at(key_from(0, 0), {0, 0, 1});
  expect_at(key_from(90, 0), {1, 0, 0});
  expect_at(key_from(-90, 0), {-1, 0, 0});
  expect_at(key_from(180, 0), {0, 0, -1});
  expect_at(key_from(30, 0), {0.5, 0, std::sqrt(0.75)});
}

TEST(Lights, ElevationsGoUpFromTheHorizon) {
  expect_at(key_from(0, 30), {0, 0.5, std::sqrt(0.75)});
  expect_at(key_from(90, 60), {0.5, std::sqrt(0.75), 0});
  expect_at(key_from(90, -60), {0.5, -std::sqrt(0.75), 0});
  expect_at(key_from(77, 90), up);
}

TEST(Lights, TurnWithTheCameraButStayUpright) {
  // Along +x the right of the view is +z; a camera that looks down as well has the same horizon.
  const double slope = std::sqrt(0.5);
  for (const glm::dvec3& forward : {glm::dvec3(1, 0, 0), glm::dvec3(slope, -slope, 0)}) {
    expect_at(key_from(0, 0, forward), {-1, 0, 0});
    expect_at(key_from(90, 0, forward), {0, 0, 1});
    expect_at(key_from(90, 90, forward), up);
  }
  // Straight down there is no "behind": +z stands in for it.
  expect_at(key_from(0, 0, {0, -1, 0}), {0, 0, 1});
  expect_at(key_from(90, 0, {0, -1, 0}), {1, 0, 0});
}

TEST(Lights, EachLightHasItsOwnPlaceAndColour) {
  config::LightSettings settings;
  settings.key_azimuth = -90;
  settings.key_elevation = 0;
  settings.key_intensity = 2;
  settings.key_colour = {1, 0.5F, 0.25F};
  settings.fill_azimuth = 90;
  settings.fill_elevation = 0;
  settings.fill_ratio = 0.25;
  settings.fill_colour = {0.5F, 0.75F, 1};
  settings.rim_azimuth = 180;
  settings.rim_elevation = 90;
  settings.rim_intensity = 0.75;
  settings.ambient = 0.5;
  const Lights lights = lights_for(settings, {0, 0, -1}, up);
  expect_at(lights.directional[0].direction, {-1, 0, 0});
  expect_at(lights.directional[1].direction, {1, 0, 0});
  expect_at(lights.directional[2].direction, up);
  expect_at(lights.directional[0].colour, {2, 1, 0.5});
  expect_at(lights.directional[1].colour, {0.25, 0.375, 0.5});  // a quarter of the key's intensity
  expect_at(lights.directional[2].colour, {0.75, 0.75, 0.75});
  expect_at(lights.ambient, {0.375, 0.4375, 0.5});  // half of it white, half the fill's colour
}

// Of the three lights that nobody chose the key comes from the left of the view, the fill from the right,
// both from the camera's side; the rim from behind what is seen; all from above.
TEST(Lights, TheUnchosenStandLeftRightAndBehind) {
  const Lights lights = lights_for({}, {0, 0, -1}, up);
  const auto& [key, fill, rim] = lights.directional;
  EXPECT_LT(key.direction.x, -0.5);
  EXPECT_GT(key.direction.z, 0.3);
  EXPECT_GT(fill.direction.x, 0.5);
  EXPECT_GT(fill.direction.z, 0.3);
  EXPECT_LT(rim.direction.z, -0.5);
  for (const DirectionalLight& light : lights.directional) {
    EXPECT_GT(light.direction.y, 0.2);
    EXPECT_NEAR(glm::length(light.direction), 1, rounding);
  }
}

}  // namespace
}  // namespace plisse::scene
