#include "io/image.h"

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

}  // namespace plisse::io
