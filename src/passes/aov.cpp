#include "passes/aov.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <vector>

namespace plisse::passes {
namespace {

using glm::vec3;

vec3 grey(const vec3& value, float scale) {
  return vec3(value.x / scale);
}
vec3 grey_of_both_signs(const vec3& value, float scale) {
  return vec3(0.5F + 0.5F * value.x / scale);
}
vec3 unit_vector(const vec3& value, float) {
  return 0.5F * value + 0.5F;
}
// A circle of hues, so that −π and π look alike.
vec3 angle(const vec3& value, float) {
  const auto hue = [&](float shift) { return 0.5F + 0.5F * std::cos(value.x - shift); };
  const float third = 2.0F * std::numbers::pi_v<float> / 3.0F;
  return {hue(0), hue(third), hue(-third)};
}
// Grey at rest, red where compressed, blue where stretched.
vec3 compression(const vec3& value, float) {
  return value.x >= 0 ? vec3(0.75F, 0.75F - 2 * value.x, 0.75F - 2 * value.x)
                      : vec3(0.75F + 2 * value.x, 0.75F + 2 * value.x, 0.75F);
}
// Very different hues for consecutive numbers.
vec3 number(const vec3& value, float) {
  const float hue = 6.2831853F * std::fmod(value.x * 0.61803399F, 1.0F);
  return {0.55F + 0.4F * std::cos(hue), 0.55F + 0.4F * std::cos(hue - 2.0944F),
          0.55F + 0.4F * std::cos(hue + 2.0944F)};
}

float of_waves(float wavelength, float) {
  return wavelength / 4;
}
// A wave as steep as it is long has the mean curvature ½ k = π/W on its crest.
float of_crests(float wavelength, float) {
  return std::numbers::pi_v<float> / wavelength;
}
float of_picture(float, float largest) {
  return std::max(largest, 1e-30F);
}

const std::vector<AovKind>& table() {
  static const std::vector<AovKind> kinds = {
      {Aov::height, "height", "", 1, 1, false, grey_of_both_signs, of_waves},
      {Aov::normal, "normal", "", 3, 0, false, unit_vector, of_waves},
      {Aov::amplitude, "amplitude", "", 1, 1, false, grey, of_waves},
      {Aov::phase, "phase", "", 1, 0, true, angle, of_waves},
      {Aov::direction, "direction", "", 3, 0, true, unit_vector, of_waves},
      {Aov::tension, "tension", "", 1, 0, true, compression, of_waves},
      {Aov::depth, "depth", "", 1, 1, false, grey, of_picture},
      {Aov::object, "object", "its number", 1, 0, false, number, of_waves},
      {Aov::beauty, "beauty", "the picture in linear light", 4, 0, false, grey, of_waves},
      {Aov::curvature, "curvature", "mean curvature, 1/m", 1, -1, false, grey_of_both_signs, of_crests},
  };
  return kinds;
}

}  // namespace

std::span<const AovKind> aov_kinds() {
  return table();
}

const AovKind& kind_of(Aov aov) {
  return *std::ranges::find(table(), aov, &AovKind::aov);
}

std::string aov_list() {
  std::string list;
  for (const AovKind& kind : table()) {
    list += (list.empty() ? "" : ", ") + kind.name;
    if (!kind.about.empty()) list += " (" + kind.about + ")";
  }
  return list;
}

gpu::Defines aov_defines() {
  gpu::Defines defines;
  for (const AovKind& kind : table()) {
    std::string name = "AOV_" + kind.name;
    for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    defines.emplace_back(name, std::to_string(static_cast<int>(kind.aov)));
  }
  return defines;
}

}  // namespace plisse::passes
