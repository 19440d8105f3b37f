// Chunks by the PNG specification (ISO/IEC 15948): length, type, data, CRC-32 of type and data; big-endian.
#include "io/picture/png.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <new>
#include <span>
#include <string_view>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/version.h"
#include "io/picture/image.h"
#include "io/picture/png_stb.h"

namespace plisse::io {
namespace {

constexpr std::array<std::uint8_t, 8> signature{137, 'P', 'N', 'G', '\r', '\n', 26, '\n'};
constexpr std::size_t chunk_frame = 12;  // length, type and CRC round a chunk's data
constexpr std::size_t ihdr_data = 13;
constexpr std::string_view hash_key = "plisse-hash";

std::uint32_t read_u32(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 |
         bytes[3];
}

void append_u32(std::vector<std::uint8_t>& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

void append_chunk(std::vector<std::uint8_t>& out, std::string_view type, std::string_view data) {
  append_u32(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  append_u32(out, libdeflate_crc32(0, out.data() + start, out.size() - start));
}

std::string text_chunk(std::string_view key, std::string_view value) {
  return std::string(key) + '\0' + std::string(value);
}

bool opaque(const Image& image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
    if (image.rgba[i] != 255) return false;
  }
  return true;
}

std::vector<std::uint8_t> without_alpha(const Image& image) {
  const std::size_t count = image.rgba.size() / 4;
  std::vector<std::uint8_t> rgb(3 * count);
  for (std::size_t i = 0; i < count; ++i) std::copy_n(&image.rgba[4 * i], 3, &rgb[3 * i]);
  return rgb;
}

void check(const Image& image) {
  const auto refuse = [](const std::string& what) { throw Error(ExitCode::no_output, "PNG: " + what); };
  if (image.width < 1 || image.height < 1 || image.width > max_image_side || image.height > max_image_side) {
    refuse(fmt::format("an image of {} × {} pixels cannot be written; 1 to {} a side are allowed",
                       image.width, image.height, max_image_side));
  }
  const std::size_t expected =
      4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.rgba.size() != expected) {
    refuse(fmt::format("{} bytes were given for {} × {} pixels, not {}", image.rgba.size(), image.width,
                       image.height, expected));
  }
}

struct Chunk {
  std::string_view type;
  std::string_view data;
};

// The chunks of a file, or nothing where anything about signature, lengths or CRCs is wrong.
std::vector<Chunk> chunks_of(std::span<const std::uint8_t> file) {
  if (file.size() < signature.size() || !std::equal(signature.begin(), signature.end(), file.begin()))
    return {};
  std::vector<Chunk> chunks;
  for (std::size_t at = signature.size(); at < file.size();) {
    const std::size_t left = file.size() - at;
    if (left < chunk_frame) return {};
    const std::size_t length = read_u32(&file[at]);
    if (length > left - chunk_frame) return {};
    const std::uint8_t* type = &file[at + 4];
    if (libdeflate_crc32(0, type, 4 + length) != read_u32(type + 4 + length)) return {};
    const auto* text = reinterpret_cast<const char*>(type);
    chunks.push_back({{text, 4}, {text + 4, length}});
    at += chunk_frame + length;
  }
  return chunks;
}

// What follows IHDR in every file of ours, up to where the hash goes.
std::vector<std::uint8_t> after_ihdr() {
  std::vector<std::uint8_t> out;
  append_chunk(out, "sRGB", std::string_view("\0", 1));  // rendering intent 0, perceptual
  append_chunk(out, "tEXt", text_chunk("Software", fmt::format("plisse {}", version)));
  return out;
}

constexpr std::size_t header_end = signature.size() + chunk_frame + ihdr_data;

}  // namespace

std::vector<std::uint8_t> with_hash(const std::vector<std::uint8_t>& png, const std::string& hash) {
  std::vector<std::uint8_t> chunk;
  append_chunk(chunk, "tEXt", text_chunk(hash_key, hash));
  const auto place = png.begin() + static_cast<std::ptrdiff_t>(header_end + after_ihdr().size());
  std::vector<std::uint8_t> out;
  out.reserve(png.size() + chunk.size());
  out.assign(png.begin(), place);
  out.insert(out.end(), chunk.begin(), chunk.end());
  out.insert(out.end(), place, png.end());
  return out;
}

std::vector<std::uint8_t> encode_png(const Image& image, const PngOptions& options) {
  check(image);
  const int level = static_cast<int>(options.level);
  const StbPng plain = opaque(image) ? stb_png(without_alpha(image), image.width, image.height, 3, level)
                                     : stb_png(image.rgba, image.width, image.height, 4, level);
  if (!plain.bytes) throw std::bad_alloc();

  const std::uint8_t* begin = plain.bytes.get();
  const std::vector<std::uint8_t> ours = after_ihdr();
  std::vector<std::uint8_t> out;
  out.reserve(plain.size + ours.size());
  out.assign(begin, begin + header_end);
  out.insert(out.end(), ours.begin(), ours.end());
  out.insert(out.end(), begin + header_end, begin + plain.size);
  if (!options.hash.empty()) return with_hash(out, options.hash);
  return out;
}

void write_png(const std::filesystem::path& path, const Image& image, const PngOptions& options) {
  write_whole_file(path, encode_png(image, options));
}

bool png_is_whole(const std::filesystem::path& path, const std::string& hash) {
  std::vector<std::uint8_t> file;
  try {
    file = read_whole_file(path);
  } catch (const Error&) {
    return false;
  }
  const std::vector<Chunk> chunks = chunks_of(file);
  if (chunks.size() < 3) return false;
  if (chunks.front().type != "IHDR" || chunks.front().data.size() != ihdr_data) return false;
  const auto is_type = [](std::string_view type) {
    return [type](const Chunk& c) { return c.type == type; };
  };
  if (std::ranges::find_if(chunks, is_type("IEND")) != chunks.end() - 1) return false;
  if (std::ranges::none_of(chunks, is_type("IDAT"))) return false;
  return std::ranges::any_of(chunks, [wanted = text_chunk(hash_key, hash)](const Chunk& chunk) {
    return chunk.type == "tEXt" && chunk.data == wanted;
  });
}

}  // namespace plisse::io
