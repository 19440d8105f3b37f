// Frames as PNG files: 8 bits, sRGB, straight alpha, named by a hash of all that decided them
// (docs/contract.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/model.h"

namespace plisse::io {

// libdeflate's levels. A shaded frame of 1280 × 1024: quick takes 17 ms and 440 kB, small 54 ms and 290 kB;
// stb's own compressor needs 78 … 110 ms for 470 … 530 kB.
enum class PngLevel { stored = 0, quick = 1, small = 6 };

struct PngOptions {
  PngLevel level = PngLevel::quick;
  std::string hash;  // goes into the file as text "plisse-hash"; empty: none
};

// RGB where every alpha is 255, else RGBA. Chunks: IHDR, sRGB, tEXt Software, tEXt plisse-hash, IDAT, IEND;
// the same pixels and options give the same bytes. May run on many threads at once. Throws Error(no_output)
// for an image without pixels, of more than 16384 a side, or whose size does not fit its data.
std::vector<std::uint8_t> encode_png(const Image& image, const PngOptions& options = {});

// The result of encode_png for the same pixels with this hash, from its result without one: an unchanged
// picture is compressed only once.
std::vector<std::uint8_t> with_hash(const std::vector<std::uint8_t>& png, const std::string& hash);

// The same as encode_png into a file, beside its final name first; throws Error(no_output).
void write_png(const std::filesystem::path& path, const Image& image, const PngOptions& options = {});

// Whether a file is a PNG whose chunks are all there with the right CRCs, from IHDR to IEND and nothing
// after, and whose plisse-hash is `hash`. What --skip-existing trusts. A missing or unreadable file is not
// whole.
bool png_is_whole(const std::filesystem::path& path, const std::string& hash);

}  // namespace plisse::io
