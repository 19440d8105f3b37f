// Textures: mip levels made here, in linear light, so that every driver and the reference filter the same.
#pragma once

#include <cstdint>
#include <vector>

namespace plisse::passes {

struct TextureLevel {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // straight alpha, rows from top to bottom
  bool srgb = true;                // colours; false: a normal map, which is linear
};

// The image and its halves down to 1×1; 2×2 texels average in linear light, colours weighted by alpha.
// Normals become shorter where they differ; this does not flatten them, since the quotients that give the
// slopes are averaged.
std::vector<TextureLevel> mip_levels(int width, int height, const std::vector<std::uint8_t>& rgba,
                                     bool srgb = true);

class Texture {
 public:
  Texture() = default;
  explicit Texture(const std::vector<TextureLevel>& levels);
  ~Texture();
  Texture(Texture&& other) noexcept { *this = static_cast<Texture&&>(other); }
  Texture& operator=(Texture&& other) noexcept;
  void bind(int unit) const;
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  unsigned id_ = 0;
  int width_ = 0, height_ = 0;
};

}  // namespace plisse::passes
