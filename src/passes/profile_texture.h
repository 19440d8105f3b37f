// A profile as the shaders look it up (shaders/common/waves.glsl), and what they are compiled for.
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
  void bind() const;  // where common/waves.glsl expects it

 private:
  unsigned id_ = 0;
};

// The defines of common/waves.glsl: blend, finer waves, and whether the profile needs no table.
gpu::Defines wave_defines(const Profile& profile, bool smooth_blend);

}  // namespace plisse::passes
