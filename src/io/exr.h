// Float images for what has no colour (heights, depths, normals): OpenEXR through tinyexr, 32 bits a channel.
#pragma once

#include <filesystem>
#include <span>

namespace plisse::io {

// `values` holds width·height·channels entries, channels interleaved, rows from top to bottom, in whatever
// unit they have; channels: 1 (written as Y), 3 (RGB) or 4 (RGBA). ZIP-compressed without loss, beside its
// final name first. Throws Error(no_output) where the file cannot be written, the sizes do not fit, or a
// value is not finite.
void write_exr(const std::filesystem::path& path, int width, int height, int channels,
               std::span<const float> values);

}  // namespace plisse::io
