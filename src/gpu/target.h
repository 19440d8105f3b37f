// The target of drawing: colour and depth, with or without multisampling, resolved and read back.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace plisse::gpu {

struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;  // pixels, from the lower left corner
  bool empty() const { return width <= 0 || height <= 0; }
  bool operator==(const Rectangle&) const = default;
  // The smallest rectangle that contains both; neither may be empty.
  Rectangle united(const Rectangle& other) const {
    const int left = std::min(x, other.x), low = std::min(y, other.y);
    return {left, low, std::max(x + width, other.x + other.width) - left,
            std::max(y + height, other.y + other.height) - low};
  }
};

class Target {
 public:
  enum class Format { srgb8, rgba32f };
  Target() = default;
  // samples: 1 or 4. Throws Error(try_again) where the driver cannot.
  Target(int width, int height, int samples, Format format);
  ~Target();
  Target(Target&& other) noexcept { *this = std::move(other); }
  Target& operator=(Target&& other) noexcept;

  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return samples_; }
  void bind() const;
  void bind_resolved()
      const;  // to draw without multisampling: before `resolve` outside its rectangle, after it on top
  // Averages the samples of one rectangle (the rest of the resolved picture keeps what was drawn there).
  void resolve(const Rectangle& area) const;
  // Rows from top to bottom. Reads the resolved picture.
  std::vector<std::uint8_t> read_rgba8() const;
  std::vector<float> read_rgba32f() const;

 private:
  unsigned draw_ = 0, read_ = 0;                    // framebuffers; the same where samples = 1
  unsigned colour_ = 0, depth_ = 0, resolved_ = 0;  // renderbuffers
  int width_ = 0, height_ = 0, samples_ = 1;
};

}  // namespace plisse::gpu
