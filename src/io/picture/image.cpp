#include "io/picture/image.h"

#include <cmath>

#include <fmt/format.h>

#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/import_texture.h"

namespace plisse::io {

Image decode_image(std::span<const std::uint8_t> bytes, const std::string& name) {
  std::string why;
  auto image = decode_image(std::as_bytes(bytes), why);
  if (!image) {
    throw Error(
        ExitCode::bad_input,
        fmt::format("{}: is no picture that can be read ({}); PNG, JPEG, TGA, BMP, GIF, PSD and PNM can",
                    name, why));
  }
  return std::move(*image);
}

Image load_image(const std::filesystem::path& path) {
  return decode_image(read_whole_file(path), path.string());
}

double amount_at(const Image& image, const glm::dvec2& uv) {
  const auto texel = [&](int x, int y) {
    const auto wrapped = [](int i, int n) { return static_cast<std::size_t>(((i % n) + n) % n); };
    const std::uint8_t* p =
        &image.rgba[4 * (wrapped(y, image.height) * static_cast<std::size_t>(image.width) +
                         wrapped(x, image.width))];
    return (0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]) / 255 * p[3] / 255;
  };
  const glm::dvec2 within = uv - glm::floor(uv);
  const double x = within.x * image.width - 0.5, y = (1 - within.y) * image.height - 0.5;
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  const double s = x - left, t = y - top;
  return glm::mix(glm::mix(texel(left, top), texel(left + 1, top), s),
                  glm::mix(texel(left, top + 1), texel(left + 1, top + 1), s), t);
}

}  // namespace plisse::io
