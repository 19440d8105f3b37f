// Interpolation modes of glTF samplers (see import_gltf_modes.h).
#include "io/import_gltf_modes.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/log.h"

namespace plisse::io {
namespace {

using Json = nlohmann::json;

// The JSON of a .gltf, or of the first chunk of a .glb (glTF 2.0, section 4.4). Discarded where it cannot be
// read.
Json read_json(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::array<std::uint32_t, 5> head{};  // magic, version, length; chunk length, chunk type
  stream.read(reinterpret_cast<char*>(head.data()), sizeof head);
  constexpr std::uint32_t magic = 0x46546C67;  // "glTF", little endian
  if (!stream || head[0] != magic) {
    stream.clear();
    stream.seekg(0);
    return Json::parse(stream, nullptr, false);
  }
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || head[3] > size) return Json::parse("", nullptr, false);
  std::string text(head[3], '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  return Json::parse(text, nullptr, false);
}

const Json& member(const Json& object, const char* key) {
  static const Json nothing;
  const auto found = object.is_object() ? object.find(key) : object.end();
  return object.is_object() && found != object.end() ? *found : nothing;
}

const Json& item(const Json& array, const Json& index) {
  static const Json nothing;
  if (!array.is_array() || !index.is_number_unsigned() || index.get<std::uint64_t>() >= array.size())
    return nothing;
  return array[index.get<std::size_t>()];
}

std::string text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : std::string{};
}

}  // namespace

void restore_gltf_modes(const AssimpScene& from, Model& model) {
  const Json file = read_json(from.path);
  const Json& animations = member(file, "animations");
  bool cubic = false;
  for (std::size_t a = 0; a < model.clips.size(); ++a) {
    const Json& animation = item(animations, Json(a));
    for (const Json& channel : member(animation, "channels")) {
      const std::string mode =
          text(member(item(member(animation, "samplers"), member(channel, "sampler")), "interpolation"));
      cubic |= mode == "CUBICSPLINE";
      if (mode != "STEP") continue;
      const Json& target = member(channel, "target");
      const Json& index = member(target, "node");
      const Json& node = item(member(file, "nodes"), index);
      if (!node.is_object()) continue;
      // assimp names a node that has no name by its place.
      const std::string named = text(member(node, "name"));
      const auto id =
          from.node_ids.find(named.empty() ? fmt::format("nodes[{}]", index.get<std::size_t>()) : named);
      if (id == from.node_ids.end()) continue;
      for (Channel& track : model.clips[a].channels) {
        if (track.node != id->second) continue;
        const std::string path = text(member(target, "path"));
        if (path == "translation") track.translation.interpolation = Interpolation::step;
        if (path == "rotation") track.rotation.interpolation = Interpolation::step;
        if (path == "scale") track.scale.interpolation = Interpolation::step;
        if (path == "weights") track.morph_weights.interpolation = Interpolation::step;
      }
    }
  }
  if (cubic)
    log::warn_once(
        "cubic " + from.path.string(),
        fmt::format("{}: cubic spline keys are joined by straight lines; their tangents are not read",
                    from.path.string()));
}

}  // namespace plisse::io
