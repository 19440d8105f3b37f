// Float images for data that is not colour (heights, depths, normals): OpenEXR by tinyexr, 32 bits a channel.
#pragma once

#include <filesystem>
#include <span>

namespace plisse::io {

// `values` holds width·height·channels entries, channels interleaved, rows from top to bottom, in any unit;
// channels: 1 (written as Y), 3 (RGB) or 4 (RGBA). ZIP-compressed without loss, beside its final name first.
// Throws Error(no_output) where the file cannot be written, the sizes do not fit, or a value is not finite.
void write_exr(const std::filesystem::path& path, int width, int height, int channels,
               std::span<const float> values);

}  // namespace plisse::io
