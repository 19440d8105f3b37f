#include "passes/texture.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/colour.h"
#include "gpu/context.h"

namespace plisse::passes {
namespace {

const std::array<double, 256>& linear_of_byte() {
  static const auto table = [] {
    std::array<double, 256> values{};
    for (int i = 0; i < 256; ++i) values[static_cast<std::size_t>(i)] = srgb_to_linear(i / 255.0);
    return values;
  }();
  return table;
}

TextureLevel halved(const TextureLevel& from) {
  TextureLevel to{std::max(1, from.width / 2), std::max(1, from.height / 2), {}, from.srgb};
  to.rgba.resize(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height) * 4);
  const auto& linear = linear_of_byte();
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      std::array<double, 3> colour{};
      double alpha = 0;
      for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i) {
          const int sx = std::min(2 * x + i, from.width - 1), sy = std::min(2 * y + j, from.height - 1);
          const auto* texel =
              &from.rgba[(static_cast<std::size_t>(sy) * static_cast<std::size_t>(from.width) +
                          static_cast<std::size_t>(sx)) *
                         4];
          // Transparent texels have a small weight, since a completely transparent block would have no colour
          // otherwise.
          const double weight = texel[3] / 255.0 + 1e-6;
          for (std::size_t c = 0; c < 3; ++c)
            colour[c] += weight * (from.srgb ? linear[texel[c]] : texel[c] / 255.0);
          alpha += weight;
        }
      }
      auto* texel = &to.rgba[(static_cast<std::size_t>(y) * static_cast<std::size_t>(to.width) +
                              static_cast<std::size_t>(x)) *
                             4];
      for (std::size_t c = 0; c < 3; ++c) {
        const double mean = std::min(1.0, colour[c] / alpha);
        texel[c] = static_cast<std::uint8_t>(std::lround(255 * (from.srgb ? linear_to_srgb(mean) : mean)));
      }
      texel[3] = static_cast<std::uint8_t>(std::lround(std::clamp(255 * (alpha - 4e-6) / 4, 0.0, 255.0)));
    }
  }
  return to;
}

}  // namespace

std::vector<TextureLevel> mip_levels(int width, int height, const std::vector<std::uint8_t>& rgba,
                                     bool srgb) {
  std::vector<TextureLevel> levels{{width, height, rgba, srgb}};
  while (levels.back().width > 1 || levels.back().height > 1) levels.push_back(halved(levels.back()));
  return levels;
}

Texture::Texture(const std::vector<TextureLevel>& levels)
    : width_(levels.front().width), height_(levels.front().height) {
  glCreateTextures(GL_TEXTURE_2D, 1, &id_);
  glTextureStorage2D(id_, static_cast<GLsizei>(levels.size()),
                     levels.front().srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, width_, height_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    // OpenGL's row 0 is at v = 0, the bottom.
    const auto& level = levels[i];
    const std::size_t row = static_cast<std::size_t>(level.width) * 4;
    std::vector<std::uint8_t> flipped(level.rgba.size());
    for (std::size_t y = 0; y < static_cast<std::size_t>(level.height); ++y) {
      std::copy_n(level.rgba.data() + y * row, row,
                  flipped.data() + (static_cast<std::size_t>(level.height) - 1 - y) * row);
    }
    glTextureSubImage2D(id_, static_cast<GLint>(i), 0, 0, level.width, level.height, GL_RGBA,
                        GL_UNSIGNED_BYTE, flipped.data());
  }
  glTextureParameteri(id_, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(id_, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(id_, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTextureParameteri(id_, GL_TEXTURE_WRAP_T, GL_REPEAT);
  gpu::check("while making a texture");
}

Texture::~Texture() {
  if (id_) glDeleteTextures(1, &id_);
}

Texture& Texture::operator=(Texture&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(width_, other.width_);
  std::swap(height_, other.height_);
  return *this;
}

void Texture::bind(int unit) const {
  glBindTextureUnit(static_cast<GLuint>(unit), id_);
}

}  // namespace plisse::passes
