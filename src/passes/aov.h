// Arbitrary output variables: quantities of the drawn surface that a picture can hold instead of colours. To
// add one: a name here, a row of the table in aov.cpp, and a line in render.frag.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>

#include "gpu/program.h"

namespace plisse::passes {

enum class Aov { height, normal, amplitude, phase, direction, tension, depth, object, beauty, curvature };

struct AovKind {
  Aov aov;
  std::string name;   // of --aov and of the files; render.frag knows it as AOV_NAME
  std::string about;  // for --help; may be empty
  int channels = 1;   // in the EXR
  int power_of_metres =
      0;  // of its unit: 1 for lengths, −1 for curvatures; the shader computes in model units
  bool of_one_wave = false;  // not for displaced surfaces, which have no single wave at a point
  // The value in 0…1, for the PNG to look at. `scale`: what counts as large.
  glm::vec3 (*shown)(const glm::vec3& value, float scale) = nullptr;
  // What counts as large, from the wavelength (metres) and the largest magnitude in the picture.
  float (*scale)(float wavelength, float largest) = nullptr;
};

// "height, normal, …, object (its number), …", for --help.
std::string aov_list();
// All of them; `beauty`, the picture in linear light, is drawn by RenderPass::draw and not by draw_aov.
std::span<const AovKind> aov_kinds();
const AovKind& kind_of(Aov aov);
// AOV_HEIGHT and so on, for render.frag.
gpu::Defines aov_defines();

}  // namespace plisse::passes
