// glTF animations (glTF 2.0, 3.11): samplers with their own modes and tangents, put together per node.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/log.h"
#include "io/gltf/import_gltf_parts.h"

namespace plisse::io {
namespace {

Interpolation mode_of(const GltfValue& at) {
  const std::string name = at.text("LINEAR");
  if (name == "LINEAR") return Interpolation::linear;
  if (name == "STEP") return Interpolation::step;
  if (name == "CUBICSPLINE") return Interpolation::cubic_spline;
  at.fail(fmt::format("is '{}', must be LINEAR, STEP or CUBICSPLINE", name));
}

// Keys of `width` numbers each; `convert` makes a value of them. Key times that do not increase are dropped,
// of equal ones the last is kept.
template <typename Value, typename Convert>
Keys<Value> read_keys(GltfFile& file, const GltfValue& sampler, std::size_t width,
                      std::initializer_list<std::string_view> types, const Convert& convert) {
  Keys<Value> keys;
  keys.interpolation = mode_of(sampler["interpolation"]);
  const bool cubic = keys.interpolation == Interpolation::cubic_spline;
  const GltfArray times = read_gltf_accessor(file, sampler["input"], {"SCALAR"});
  const GltfArray output = read_gltf_accessor(file, sampler["output"], types);
  const std::size_t per_key = (cubic ? 3 : 1) * width;
  if (output.values.size() < times.count * per_key)
    sampler["output"].fail(
        fmt::format("has {} numbers; {} keys need {} each", output.values.size(), times.count, per_key));
  for (std::size_t k = 0; k < times.count; ++k) {
    const double time = times.values[k];
    if (!std::isfinite(time) || (!keys.times.empty() && time < keys.times.back())) continue;
    if (!keys.times.empty() && time == keys.times.back()) {
      keys.times.pop_back();
      keys.values.pop_back();
      if (cubic) keys.in_tangents.pop_back(), keys.out_tangents.pop_back();
    }
    const double* from = output.values.data() + k * per_key;
    keys.times.push_back(time);
    keys.values.push_back(convert(from + (cubic ? width : 0)));
    if (!cubic) continue;
    keys.in_tangents.push_back(convert(from));
    keys.out_tangents.push_back(convert(from + 2 * width));
  }
  return keys;
}

// A track that the clip does not have stays at the node's own value, as the file writes it: taken out of the
// matrix again, a scale of (1, −1, 1) would come back as another mirror and another turn.
template <typename Value>
void hold(Keys<Value>& keys, const Value& value) {
  if (!keys.times.empty()) return;
  keys.times = {0};
  keys.values = {value};
}
void hold_own_parts(const GltfValue& node, Channel& channel) {
  if (node["matrix"]) return;
  if (channel.translation.times.empty() && channel.rotation.times.empty() && channel.scale.times.empty())
    return;
  const std::vector<double> t = node["translation"].numbers(3, {0, 0, 0});
  const std::vector<double> q = node["rotation"].numbers(4, {0, 0, 0, 1});
  const std::vector<double> s = node["scale"].numbers(3, {1, 1, 1});
  hold(channel.translation, glm::dvec3(t[0], t[1], t[2]));
  hold(channel.rotation, glm::dquat(q[3], q[0], q[1], q[2]));
  hold(channel.scale, glm::dvec3(s[0], s[1], s[2]));
}

class ClipReader {
 public:
  ClipReader(GltfFile& file, const std::vector<int>& nodes, const Model& model)
      : file_(file), nodes_(nodes), model_(model) {}

  Clip read(const GltfValue& source, std::size_t id) {
    Clip clip;
    clip.name = source["name"].text("");
    if (clip.name.empty()) clip.name = fmt::format("clip {}", id);
    std::map<std::size_t, Channel> channels;  // by the file's node
    const GltfValue sources = source["channels"];
    std::size_t lost = 0;
    for (std::size_t c = 0; c < sources.size(); ++c) {
      const GltfValue target = sources.at(c)["target"];
      const std::string path = target["path"].text("");
      const bool known = path == "translation" || path == "rotation" || path == "scale" || path == "weights";
      if (!target["node"] || !known) {
        ++lost;
        continue;
      }
      const std::size_t node = target["node"].index(file_.list("nodes"));
      const GltfValue samplers = source["samplers"];
      read_track(samplers.at(sources.at(c)["sampler"].index(samplers)), path, node, channels[node]);
    }
    if (lost > 0)
      log::warn_once("channels " + file_.path().string() + clip.name,
                     fmt::format("{}: {} channels of clip '{}' move nothing that plisse has",
                                 file_.path().string(), lost, clip.name));
    for (auto& [node, channel] : channels) {
      channel.node = nodes_[node];
      for (const auto* times : {&channel.translation.times, &channel.rotation.times, &channel.scale.times,
                                &channel.morph_weights.times})
        if (!times->empty()) clip.duration = std::max(clip.duration, times->back());
      hold_own_parts(file_.list("nodes").at(node), channel);
      clip.channels.push_back(std::move(channel));
    }
    return clip;
  }

 private:
  void read_track(const GltfValue& sampler, const std::string& path, std::size_t node, Channel& channel) {
    const auto vector = [](const double* v) { return glm::dvec3(v[0], v[1], v[2]); };
    if (path == "translation")
      channel.translation = read_keys<glm::dvec3>(file_, sampler, 3, {"VEC3"}, vector);
    if (path == "scale") channel.scale = read_keys<glm::dvec3>(file_, sampler, 3, {"VEC3"}, vector);
    if (path == "rotation")
      channel.rotation = read_keys<glm::dquat>(
          file_, sampler, 4, {"VEC4"}, [](const double* v) { return glm::dquat(v[3], v[0], v[1], v[2]); });
    if (path == "weights") {
      const std::size_t targets = model_.nodes[static_cast<std::size_t>(nodes_[node])].morph_weights.size();
      if (targets == 0) return;  // of a mesh that is not shown
      channel.morph_weights = read_keys<std::vector<double>>(
          file_, sampler, targets, {"SCALAR"},
          [targets](const double* v) { return std::vector<double>(v, v + targets); });
    }
  }

  GltfFile& file_;
  const std::vector<int>& nodes_;
  const Model& model_;
};

}  // namespace

void read_gltf_clips(GltfFile& file, const std::vector<int>& nodes, Model& model) {
  const GltfValue sources = file.list("animations");
  for (std::size_t a = 0; a < sources.size(); ++a)
    model.clips.push_back(ClipReader(file, nodes, model).read(sources.at(a), a));
}

}  // namespace plisse::io
