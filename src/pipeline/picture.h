// A finished picture on its way into files.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "io/picture/image.h"

namespace plisse::pipeline {

// A finished picture and its PNG, which is compressed at its first use: a picture of several equal frames is
// compressed once. Thread-safe.
class Picture {
 public:
  explicit Picture(io::Image image) : image_(std::move(image)) {}
  // As long as nobody asked for its PNG.
  const io::Image& image() const { return image_; }
  // The file of a frame with this hash (empty: none), and whether this call compressed it.
  std::pair<std::vector<std::uint8_t>, bool> png(const std::string& hash);

 private:
  io::Image image_;
  std::once_flag once_;
  std::vector<std::uint8_t> png_;
};

}  // namespace plisse::pipeline
