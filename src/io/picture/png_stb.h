// stb_image_write with libdeflate as its compressor, behind one function: its settings are globals and stay
// inside.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>

namespace plisse::io {

struct FreeMalloc {
  void operator()(std::uint8_t* bytes) const { std::free(bytes); }
};

struct StbPng {
  std::unique_ptr<std::uint8_t, FreeMalloc> bytes;  // null where memory ran out
  std::size_t size = 0;
};

// A PNG of IHDR, one IDAT and IEND. `pixels` has width·height·channels entries; 3 channels RGB, 4 RGBA.
StbPng stb_png(std::span<const std::uint8_t> pixels, int width, int height, int channels, int level);

}  // namespace plisse::io
