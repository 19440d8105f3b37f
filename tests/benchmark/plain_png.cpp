#include "benchmark/plain_png.h"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image_write.h>

namespace plisse::benchmark {

std::size_t stock_png(const std::uint8_t* pixels, int width, int height, int channels) {
  std::size_t bytes = 0;
  const auto count = [](void* total, void*, int size) {
    *static_cast<std::size_t*>(total) += static_cast<std::size_t>(size);
  };
  stbi_write_png_to_func(count, &bytes, width, height, channels, pixels, width * channels);
  return bytes;
}

}  // namespace plisse::benchmark
