// Pictures for materials: PNG, JPEG, BMP, TGA and what else stb_image decodes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "io/model.h"

namespace plisse::io {

// Decodes a picture file held in memory; nothing where it cannot be decoded, with the reason in `why`.
std::optional<Image> decode_image(std::span<const std::byte> bytes, std::string& why);

// Warns once that a file outside the folder is not read, and what to do.
void warn_outside(const std::filesystem::path& model, const std::filesystem::path& file);

// Finds a texture that a model file names, although the path may be another machine's: as given, with / for
// \ and %20 decoded, relative to the model's folder, then by its bare name there and in textures/; then the
// same with capitals and small letters alike. Empty if not found; a file outside the folder is ignored with a
// warning.
std::filesystem::path find_texture(const std::filesystem::path& model, const std::string& name);

// Adds the texture to model.textures, or finds it there under the same name and for the same use.
// `model_file` is the file that names it. −1, after one warning, where it is missing or cannot be decoded:
// then the base colour is used.
int load_texture_file(const std::filesystem::path& model_file, const std::string& name, Texture::Use use,
                      Model& model);
int load_texture_bytes(std::span<const std::byte> bytes, const std::string& name, Texture::Use use,
                       Model& model);

}  // namespace plisse::io
