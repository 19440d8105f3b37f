#include "passes/profile_texture.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

#include "gpu/context.h"

namespace plisse::passes {
namespace {

constexpr unsigned unit = 1;

// Whether the shaders can compute the profile without a table.
bool is_sinusoid(const Profile& profile) {
  for (std::size_t i = 0; i < profile.f.size(); ++i) {
    const double phase =
        2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(profile.f.size());
    if (std::abs(profile.f[i] - std::cos(phase)) > 1e-9 ||
        std::abs(profile.derivative[i] + std::sin(phase)) > 1e-9)
      return false;
  }
  return true;
}

}  // namespace

ProfileTexture::ProfileTexture(const Profile& profile) {
  std::vector<glm::vec2> table(Profile::size);
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = glm::vec2(profile.f[i], profile.derivative[i]);
  glCreateTextures(GL_TEXTURE_1D, 1, &id_);
  glTextureStorage1D(id_, 1, GL_RG32F, Profile::size);
  glTextureSubImage1D(id_, 0, 0, Profile::size, GL_RG, GL_FLOAT, table.data());
  glTextureParameteri(id_, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(id_, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(id_, GL_TEXTURE_WRAP_S, GL_REPEAT);
  gpu::check("while making a profile");
}

ProfileTexture::~ProfileTexture() {
  glDeleteTextures(1, &id_);
}

void ProfileTexture::bind() const {
  glBindTextureUnit(unit, id_);
}

gpu::Defines wave_defines(const Profile& profile, bool smooth_blend) {
  gpu::Defines defines;
  if (!smooth_blend) defines.emplace_back("LINEAR_BLEND", "1");
  if (profile.fine_waves > 0) {
    // Written into the shader as decimals: a uniform that every pixel reads costs more.
    defines.emplace_back("FINE_WAVES", fmt::format("{}.0", profile.fine_waves));
    defines.emplace_back("COARSE_SHARE", fmt::format("{:.9e}", profile.coarse));
    defines.emplace_back("FINE_SHARE", fmt::format("{:.9e}", profile.fine));
  }
  if (is_sinusoid(profile)) defines.emplace_back("SINUSOID", "1");
  return defines;
}

}  // namespace plisse::passes
