// PNG as stb_image_write makes it with its own compressor.
#pragma once

#include <cstddef>
#include <cstdint>

namespace plisse::benchmark {

// Encodes and returns the bytes it would have written. channels: 3 or 4.
std::size_t stock_png(const std::uint8_t* pixels, int width, int height, int channels);

}  // namespace plisse::benchmark
