// The glTF file and its bytes: JSON, a .glb's chunks (glTF 2.0, 4.4), buffers, buffer views.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/log.h"
#include "io/gltf/import_gltf_parts.h"
#include "io/inside_folder.h"

namespace plisse::io {
namespace {

using Json = nlohmann::json;

// Of what compression and absent data may unfold to: a mesh of ten million vertices with all its attributes.
constexpr std::uint64_t most_unfolded_bytes = std::uint64_t{2} << 30;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw Error(ExitCode::bad_input, fmt::format("{}: {}", path.string(), what));
}

std::optional<std::vector<std::byte>> read_file(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  if (!stream) return std::nullopt;
  std::vector<std::byte> bytes(static_cast<std::size_t>(stream.tellg()));
  stream.seekg(0);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream) return std::nullopt;
  return bytes;
}

std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;) word = word << 8 | std::to_integer<std::uint32_t>(bytes[offset + i]);
  return word;
}

constexpr std::uint32_t glb_magic = 0x46546C67;  // "glTF", little endian

// The chunks of a .glb: JSON, and bytes where it has some.
struct Chunks {
  std::span<const std::byte> json, binary;
};
Chunks chunks_of(std::span<const std::byte> file, const std::filesystem::path& path) {
  constexpr std::uint32_t json_type = 0x4E4F534A, binary_type = 0x004E4942;
  if (file.size() < 20) fail(path, fmt::format("is cut off: {} bytes hold no glTF", file.size()));
  if (word_at(file, 4) != 2)
    fail(path, fmt::format("is glTF version {}; only 2 is read: export it again", word_at(file, 4)));
  const std::size_t stated = word_at(file, 8);
  if (stated > file.size())
    fail(path, fmt::format("is cut off: it states {} bytes and has {}; copy it again", stated, file.size()));
  Chunks chunks;
  for (std::size_t at = 12; at + 8 <= stated;) {
    const std::size_t size = word_at(file, at);
    const std::uint32_t type = word_at(file, at + 4);
    if (size > stated - at - 8)
      fail(path, fmt::format("the chunk at byte {} states {} bytes, {} are left", at, size, stated - at - 8));
    const auto bytes = file.subspan(at + 8, size);
    if (type == json_type && chunks.json.empty()) chunks.json = bytes;
    if (type == binary_type && chunks.binary.empty()) chunks.binary = bytes;
    at += 8 + size;
  }
  if (chunks.json.empty()) fail(path, "is a .glb without a JSON chunk");
  return chunks;
}

Json parse(std::span<const std::byte> text, const std::filesystem::path& path) {
  const char* first = reinterpret_cast<const char*>(text.data());
  try {
    return Json::parse(first, first + text.size());
  } catch (const Json::exception& error) {
    const std::string_view words = error.what();
    const std::size_t after = words.find("] ");
    fail(path,
         fmt::format("is no glTF: {}", after == std::string_view::npos ? words : words.substr(after + 2)));
  }
}

// What changes only how a surface shines or is lit, or nothing here.
bool only_looks(const std::string& extension) {
  return extension.starts_with("KHR_materials_") || extension.starts_with("KHR_lights_") ||
         extension.starts_with("KHR_xmp") || extension == "FB_ngon_encoding";
}
bool is_known(const std::string& extension) {
  static constexpr std::array<std::string_view, 5> known{"KHR_mesh_quantization", "EXT_mesh_gpu_instancing",
                                                         "KHR_texture_transform", "EXT_meshopt_compression",
                                                         "KHR_draco_mesh_compression"};
  return std::find(known.begin(), known.end(), extension) != known.end() || only_looks(extension);
}

void check_extensions(const GltfValue& root, const std::filesystem::path& path) {
  const auto unknown = [&](const char* list) {
    std::vector<std::string> names;
    const GltfValue extensions = root[list];
    for (std::size_t i = 0; i < extensions.size(); ++i)
      if (const std::string name = extensions.at(i).text(""); !is_known(name)) names.push_back(name);
    return names;
  };
  if (const auto names = unknown("extensionsRequired"); !names.empty())
    fail(path,
         fmt::format("requires {}, which plisse does not read; export it without", fmt::join(names, ", ")));
  if (const auto names = unknown("extensionsUsed"); !names.empty())
    log::warn_once("extensions " + path.string(),
                   fmt::format("{}: what {} says is left out", path.string(), fmt::join(names, ", ")));
}

// RFC 4648; stops at "=". Nothing where another character is no digit.
std::optional<std::vector<std::byte>> from_base64(std::string_view text) {
  const auto digit = [](char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
  };
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3);
  unsigned group = 0, bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    if (c == '\n' || c == '\r') continue;
    const int value = digit(c);
    if (value < 0) return std::nullopt;
    group = group << 6 | static_cast<unsigned>(value);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::byte>(group >> bits & 0xFFU));
  }
  return bytes;
}

}  // namespace

GltfFile::GltfFile(const std::filesystem::path& path) : path_(path) {
  auto file = read_file(path);
  if (!file) fail(path, "cannot be read");
  if (file->empty()) fail(path, "is empty");
  if (file->size() >= 4 && word_at(*file, 0) == glb_magic) {
    const Chunks chunks = chunks_of(*file, path);
    json_ = std::make_unique<Json>(parse(chunks.json, path));
    chunk_.assign(chunks.binary.begin(), chunks.binary.end());
  } else {
    json_ = std::make_unique<Json>(parse(*file, path));
  }
  if (!json_->is_object()) fail(path, "is no glTF: its JSON is not an object");
  // Version 1.0 had names in place of numbers, and at first no version.
  const Json& json = *json_;
  const auto is_named = [&](const char* list) { return json.contains(list) && json[list].is_object(); };
  if (is_named("meshes") || is_named("nodes") || is_named("accessors"))
    fail(path, "is glTF version 1; only 2 is read: export it again");
  const std::string version = root()["asset"]["version"].text("2.0");
  if (!version.starts_with("2."))
    fail(path, fmt::format("is glTF version {}; only 2 is read: export it again", version));
  check_extensions(root(), path);
}

GltfFile::~GltfFile() = default;

GltfValue GltfFile::root() const {
  return {path_, json_.get(), ""};
}

void GltfFile::spend(std::uint64_t bytes, const GltfValue& for_what) {
  if (bytes > most_unfolded_bytes - spent_)
    for_what.fail(
        fmt::format("unfolds to {} bytes; {} are the most for one file's compressed and absent data", bytes,
                    most_unfolded_bytes));
  spent_ += bytes;
}

std::optional<std::vector<std::byte>> GltfFile::data_of_uri(const GltfValue& uri) {
  const std::string text = uri.text("");
  if (!text.starts_with("data:")) return std::nullopt;
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) uri.fail("is a data URI without a comma");
  const std::string_view data = std::string_view(text).substr(comma + 1);
  if (std::string_view(text).substr(0, comma).ends_with(";base64")) {
    auto bytes = from_base64(data);
    if (!bytes) uri.fail("is not base64");
    return bytes;
  }
  const std::string plain = percent_decoded(std::string(data));
  const auto bytes = std::as_bytes(std::span(plain));
  return std::vector<std::byte>(bytes.begin(), bytes.end());
}

std::span<const std::byte> GltfFile::buffer(const GltfValue& at) {
  const std::size_t id = at.index(list("buffers"));
  const GltfValue source = list("buffers").at(id);
  const std::uint64_t stated = source["byteLength"].count();
  const GltfValue uri = source["uri"];
  std::span<const std::byte> bytes = chunk_;
  if (uri) {
    auto [known, fresh] = buffers_.try_emplace(id);
    if (fresh) {
      if (auto data = data_of_uri(uri)) {
        known->second = std::move(*data);
      } else {
        const std::string name = uri.text("");
        if (name.find("://") != std::string::npos)
          uri.fail(fmt::format("'{}': only files beside it are read", name));
        const std::filesystem::path file = inside_folder(path_.parent_path(), percent_decoded(name));
        if (file.empty()) uri.fail(fmt::format("'{}' lies outside the model's folder; move it there", name));
        auto content = read_file(file);
        if (!content) uri.fail(fmt::format("'{}' cannot be read beside the model", name));
        known->second = std::move(*content);
      }
    }
    bytes = known->second;
  } else if (id != 0 || chunk_.empty()) {
    source.fail("has neither uri nor bytes");
  }
  if (stated > bytes.size()) source.fail(fmt::format("states {} bytes and has {}", stated, bytes.size()));
  return bytes.first(static_cast<std::size_t>(stated));
}

std::span<const std::byte> GltfFile::part(std::span<const std::byte> bytes, const GltfValue& of) const {
  const std::uint64_t offset = of["byteOffset"].count(0), length = of["byteLength"].count();
  if (offset > bytes.size() || length > bytes.size() - offset)
    of.fail(fmt::format("bytes {} to {} of a buffer of {}", offset, offset + length, bytes.size()));
  return bytes.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
}

std::span<const std::byte> GltfFile::view(const GltfValue& at) {
  const std::size_t id = at.index(list("bufferViews"));
  const GltfValue source = list("bufferViews").at(id);
  const GltfValue compression = source["extensions"]["EXT_meshopt_compression"];
  if (!compression) return part(buffer(source["buffer"]), source);
  auto [known, fresh] = decompressed_views_.try_emplace(id);
  if (fresh) known->second = decompressed(compression);
  return known->second;
}

// EXT_meshopt_compression: bitstreams and filters are meshoptimizer's own.
std::vector<std::byte> GltfFile::decompressed(const GltfValue& compression) {
  const std::span<const std::byte> from = part(buffer(compression["buffer"]), compression);
  const std::uint64_t count = compression["count"].count(), stride = compression["byteStride"].count();
  const std::string mode = compression["mode"].text(""), filter = compression["filter"].text("NONE");
  const bool vertices = mode == "ATTRIBUTES";
  if (!vertices && mode != "TRIANGLES" && mode != "INDICES")
    compression["mode"].fail("must be ATTRIBUTES, TRIANGLES or INDICES");
  if (vertices ? stride == 0 || stride > 256 || stride % 4 != 0 : stride != 2 && stride != 4)
    compression["byteStride"].fail(fmt::format("is {} for mode {}", stride, mode));
  if (mode == "TRIANGLES" && count % 3 != 0) compression["count"].fail("is not a multiple of three");
  if (count > most_unfolded_bytes) compression["count"].fail(fmt::format("is {}", count));
  const bool filtered = filter != "NONE";
  if (filtered && (filter == "OCTAHEDRAL"    ? stride != 4 && stride != 8
                   : filter == "QUATERNION"  ? stride != 8
                   : filter == "EXPONENTIAL" ? !vertices
                                             : true))
    compression["filter"].fail(fmt::format("'{}' with a stride of {} is unknown", filter, stride));

  spend(count * stride, compression);
  std::vector<std::byte> to(static_cast<std::size_t>(count * stride));
  const auto* bytes = reinterpret_cast<const unsigned char*>(from.data());
  const auto items = static_cast<std::size_t>(count), size = static_cast<std::size_t>(stride);
  const int error = vertices ? meshopt_decodeVertexBuffer(to.data(), items, size, bytes, from.size())
                    : mode == "TRIANGLES"
                        ? meshopt_decodeIndexBuffer(to.data(), items, size, bytes, from.size())
                        : meshopt_decodeIndexSequence(to.data(), items, size, bytes, from.size());
  if (error != 0) compression.fail(fmt::format("cannot be decompressed (meshoptimizer says {})", error));
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(to.data(), items, size);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(to.data(), items, size);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(to.data(), items, size);
  return to;
}

}  // namespace plisse::io
