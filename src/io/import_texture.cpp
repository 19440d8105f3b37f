// Decoding and finding textures (see import_texture.h). stb_image is compiled here, with internal linkage.
#include "io/import_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <vector>

#include "base/log.h"
#include "base/text.h"
#include "io/inside_folder.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_FAILURE_USERMSG
#define STBI_MAX_DIMENSIONS 16384  // OpenGL 4.5 guarantees this size of a texture
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // of fields that its memory reader never looks at
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace plisse::io {
std::optional<Image> decode_image(std::span<const std::byte> bytes, std::string& why) {
  if (bytes.empty() || bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    why = bytes.empty() ? "it is empty" : "it is larger than 2 GB";
    return std::nullopt;
  }
  Image image;
  int channels = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels{
      stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()),
                            &image.width, &image.height, &channels, 4),
      stbi_image_free};
  if (!pixels) {
    why = stbi_failure_reason();
    return std::nullopt;
  }
  image.rgba.assign(pixels.get(), pixels.get() + std::size_t{4} * static_cast<std::size_t>(image.width) *
                                                     static_cast<std::size_t>(image.height));
  return image;
}

void warn_outside(const std::filesystem::path& model, const std::filesystem::path& file) {
  log::warn_once(
      "outside " + file.string(),
      fmt::format("{}: names {}, which lies outside its folder and is not read; copy it into the folder",
                  model.string(), file.string()));
}

namespace {

// The file of this name below a folder where capitals count as small letters, as on the systems that many
// models come from; relative to the folder. Empty where there is none, and for names that lead out of the
// folder.
std::filesystem::path in_any_case(const std::filesystem::path& folder, const std::filesystem::path& name) {
  namespace fs = std::filesystem;
  if (name.is_absolute() || name.string().find('\0') != std::string::npos) return {};
  fs::path found;
  for (const fs::path& part : name) {
    if (part == "..") return {};
    const std::string wanted = lower_case(part.string());
    std::vector<std::string> alike;
    std::error_code error;
    for (fs::directory_iterator
             entry(folder.empty() && found.empty() ? fs::path(".") : folder / found, error),
         end;
         !error && entry != end; entry.increment(error))
      if (const std::string here = entry->path().filename().string(); lower_case(here) == wanted)
        alike.push_back(here);
    if (part == ".") alike = {"."};
    if (alike.empty()) return {};
    found /= *std::min_element(alike.begin(), alike.end());  // in whatever order the folder is read
  }
  std::error_code error;
  return fs::is_regular_file(folder / found, error) ? found : fs::path{};
}

}  // namespace

std::filesystem::path find_texture(const std::filesystem::path& model, const std::string& name) {
  namespace fs = std::filesystem;
  std::string decoded = percent_decoded(name);
  std::replace(decoded.begin(), decoded.end(), '\\', '/');
  if (decoded.starts_with("file://")) decoded.erase(0, 7);
  const fs::path folder = model.parent_path();
  const fs::path bare = fs::path(decoded).filename();
  const std::array<fs::path, 5> candidates{name, decoded, bare, "textures" / bare, "Textures" / bare};
  for (const fs::path& candidate : candidates) {
    std::error_code error;
    if (!fs::is_regular_file(folder / candidate, error)) continue;
    if (!inside_folder(folder, candidate.string()).empty()) return folder / candidate;
    warn_outside(model, candidate);
  }
  for (const fs::path& candidate : candidates) {
    const fs::path found = in_any_case(folder, candidate);
    if (!found.empty() && !inside_folder(folder, found.string()).empty()) return folder / found;
  }
  return {};
}

int load_texture_bytes(std::span<const std::byte> bytes, const std::string& name, Texture::Use use,
                       Model& model) {
  for (std::size_t i = 0; i < model.textures.size(); ++i)
    if (model.textures[i].name == name && model.textures[i].use == use) return static_cast<int>(i);
  std::string why;
  std::optional<Image> image = decode_image(bytes, why);
  if (!image) {
    log::warn_once("texture " + name,
                   fmt::format("texture '{}' cannot be decoded ({}); it is left out", name, why));
    return -1;
  }
  model.textures.push_back({name, std::move(*image), use});
  return static_cast<int>(model.textures.size()) - 1;
}

int load_texture_file(const std::filesystem::path& model_file, const std::string& name, Texture::Use use,
                      Model& model) {
  const std::filesystem::path path = find_texture(model_file, name);
  if (path.empty()) {
    log::warn_once("texture " + name, fmt::format("{}: texture '{}' not found beside it; it is left out",
                                                  model_file.string(), name));
    return -1;
  }
  std::ifstream stream(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  return load_texture_bytes(std::as_bytes(std::span(bytes)), path.string(), use, model);
}

}  // namespace plisse::io
