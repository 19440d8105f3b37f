// Pictures from files, where an unreadable one is an error (a model's texture is not: see import_texture.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>

#include "io/model.h"

namespace plisse::io {

// The widest and highest picture that is read: also what OpenGL 4.5 promises for textures.
inline constexpr int max_image_side = 16384;

// PNG, JPEG, TGA, BMP, GIF (its first picture), PSD, PNM → 8 bits, RGBA, rows from top to bottom (16 bits are
// cut to 8, grey is spread, missing alpha is 255). Throw Error(bad_input) with the name, what is wrong and
// what can be read.
Image load_image(const std::filesystem::path& path);
// `name` is for messages: "embedded texture 0 of fox.glb".
Image decode_image(std::span<const std::uint8_t> bytes, const std::string& name);

// A picture as a map of amounts: brightness times alpha at a place, 0…1, bilinear; v upward, repeated outside
// 0…1. Its values are not decoded as sRGB.
double amount_at(const Image& image, const glm::dvec2& uv);

}  // namespace plisse::io
