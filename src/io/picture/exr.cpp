#include "io/picture/exr.h"

#include <fmt/format.h>
#include <tinyexr.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/picture/image.h"

namespace plisse::io {

void write_exr(const std::filesystem::path& path, int width, int height, int channels,
               std::span<const float> values) {
  const auto refuse = [&](const std::string& what) {
    throw Error(ExitCode::no_output, fmt::format("{}: {}", path.string(), what));
  };
  if (width < 1 || height < 1 || width > max_image_side || height > max_image_side) {
    refuse(fmt::format("an image of {} × {} pixels cannot be written; 1 to {} a side are allowed", width,
                       height, max_image_side));
  }
  if (channels != 1 && channels != 3 && channels != 4)
    refuse(fmt::format("{} channels; 1, 3 or 4 fit", channels));
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const auto stride = static_cast<std::size_t>(channels);
  if (values.size() != pixels * stride) {
    refuse(fmt::format("{} values were given for {} × {} × {}", values.size(), width, height, channels));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      const std::size_t pixel = i / stride;
      refuse(fmt::format("channel {} of pixel ({}, {}) is not finite", i % stride,
                         pixel % static_cast<std::size_t>(width), pixel / static_cast<std::size_t>(width)));
    }
  }

  // OpenEXR keeps channels in alphabetical order: of RGBA that is the reverse.
  const std::string_view names = channels == 1 ? "Y" : channels == 3 ? "BGR" : "ABGR";
  std::vector<std::vector<float>> planes(stride, std::vector<float>(pixels));
  std::array<unsigned char*, 4> plane_pointers{};
  std::array<EXRChannelInfo, 4> infos{};
  std::array<int, 4> float_type{TINYEXR_PIXELTYPE_FLOAT, TINYEXR_PIXELTYPE_FLOAT, TINYEXR_PIXELTYPE_FLOAT,
                                TINYEXR_PIXELTYPE_FLOAT};
  for (std::size_t c = 0; c < stride; ++c) {
    for (std::size_t p = 0; p < pixels; ++p) planes[c][p] = values[p * stride + (stride - 1 - c)];
    plane_pointers[c] = reinterpret_cast<unsigned char*>(planes[c].data());
    infos[c].name[0] = names[c];
  }

  EXRHeader header;
  InitEXRHeader(&header);
  header.num_channels = channels;
  header.channels = infos.data();
  header.pixel_types = float_type.data();
  header.requested_pixel_types = float_type.data();
  header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
  EXRImage image;
  InitEXRImage(&image);
  image.num_channels = channels;
  image.images = plane_pointers.data();
  image.width = width;
  image.height = height;

  unsigned char* memory = nullptr;
  const char* message = nullptr;
  const std::size_t size = SaveEXRImageToMemory(&image, &header, &memory, &message);
  const std::unique_ptr<unsigned char, void (*)(void*)> owner(memory, std::free);
  if (size == 0) {
    const std::string text = message != nullptr ? message : "no reason given";
    FreeEXRErrorMessage(message);
    refuse("OpenEXR could not be made: " + text);
  }
  write_whole_file(path, std::span<const std::uint8_t>(memory, size));
}

}  // namespace plisse::io
