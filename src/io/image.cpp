#include "io/image.h"

#include <fmt/format.h>

#include <cstdlib>
#include <memory>

#include "base/atomic_file.h"
#include "base/error.h"

// Static: the decoder stays this file's own, whatever else a user of the library links.
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_STDIO
#define STBI_NO_HDR     // radiance maps are no surface colours
#define STBI_NO_LINEAR  // no conversions to float
#define STBI_MAX_DIMENSIONS plisse::io::max_image_side
#include <stb_image.h>

namespace plisse::io {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw Error(ExitCode::bad_input, fmt::format("{}: {}", name, what));
}

}  // namespace

Image decode_image(std::span<const std::uint8_t> bytes, const std::string& name) {
  constexpr const char* readable = "PNG, JPEG, TGA, BMP, GIF, PSD and PNM can be read";
  if (bytes.empty()) refuse(name, "is empty; a picture was expected");
  if (bytes.size() > std::size_t{1} << 30) refuse(name, "is larger than 1 GiB; a picture was expected");
  const auto size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0) {
    refuse(name, fmt::format("is no picture that can be read ({}); {}", stbi_failure_reason(), readable));
  }
  // Before decoding: a few bytes of header can ask for gigabytes.
  if (width < 1 || height < 1 || width > max_image_side || height > max_image_side) {
    refuse(name,
           fmt::format("has {} × {} pixels; from 1 to {} a side are allowed", width, height, max_image_side));
  }
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, STBI_rgb_alpha), stbi_image_free);
  if (!pixels) {
    refuse(name, fmt::format("is damaged or of an unknown kind ({}); {}", stbi_failure_reason(), readable));
  }
  const auto count = 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  return {width, height, {pixels.get(), pixels.get() + count}};
}

Image load_image(const std::filesystem::path& path) {
  return decode_image(read_whole_file(path), path.string());
}

}  // namespace plisse::io
