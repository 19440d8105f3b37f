// A profile as a texture for the shaders (shaders/common/waves.glsl), and the shaders' defines for it.
#pragma once

#include "gpu/program.h"
#include "passes/profile.h"

namespace plisse::passes {

class ProfileTexture {
 public:
  explicit ProfileTexture(const Profile& profile);
  ~ProfileTexture();
  ProfileTexture(const ProfileTexture&) = delete;
  ProfileTexture& operator=(const ProfileTexture&) = delete;
  void bind() const;  // to the unit of common/waves.glsl

 private:
  unsigned id_ = 0;
};

// The defines of common/waves.glsl: blend, finer waves, and whether the profile needs no table.
gpu::Defines wave_defines(const Profile& profile, bool smooth_blend);

}  // namespace plisse::passes
