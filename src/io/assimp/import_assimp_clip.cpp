// The assimp reader's clips. assimp 5.2.5 keeps no interpolation mode: keys are
// linear, but those of FBX files, which come from the file's own tree (import_fbx.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/log.h"
#include "io/assimp/import_assimp_parts.h"

namespace plisse::io {
namespace {

// Ticks to seconds; key times that do not increase are dropped, of equal ones the last is kept.
template <typename Value, typename Key, typename Convert>
Keys<Value> read_keys(const Key* source, unsigned count, double ticks_per_second, const Convert& convert) {
  Keys<Value> keys;
  for (unsigned k = 0; k < count; ++k) {
    const double time = source[k].mTime / ticks_per_second;
    if (!std::isfinite(time)) continue;
    if (!keys.times.empty() && time < keys.times.back()) continue;
    if (!keys.times.empty() && time == keys.times.back()) {
      keys.values.back() = convert(source[k]);
      continue;
    }
    keys.times.push_back(time);
    keys.values.push_back(convert(source[k]));
  }
  return keys;
}

// FBX calls the channel "node*index"; the others by the node's name. The weights may be with the node's
// holder of meshes (hang_meshes), which bears the same name below it.
int node_of_morph(const AssimpScene& from, const Model& model, const std::string& name) {
  auto found = from.node_ids.find(name);
  if (found == from.node_ids.end()) found = from.node_ids.find(name.substr(0, name.find_last_of('*')));
  if (found == from.node_ids.end()) return -1;
  const int id = found->second;
  if (!model.nodes[static_cast<std::size_t>(id)].morph_weights.empty()) return id;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n].parent == id && model.nodes[n].name == found->first &&
        !model.nodes[n].morph_weights.empty())
      return static_cast<int>(n);
  return id;
}

Keys<std::vector<double>> read_morph_keys(const aiMeshMorphAnim& source, double ticks_per_second,
                                          const std::vector<double>& rest_weights) {
  return read_keys<std::vector<double>>(source.mKeys, source.mNumKeys, ticks_per_second,
                                        [&](const aiMeshMorphKey& key) {
                                          std::vector<double> weights = rest_weights;
                                          for (unsigned i = 0; i < key.mNumValuesAndWeights; ++i)
                                            if (key.mValues[i] < weights.size())
                                              weights[key.mValues[i]] = key.mWeights[i];
                                          return weights;
                                        });
}

}  // namespace

void read_clips(const AssimpScene& from, Model& model) {
  if (from.fbx != nullptr) {
    from.fbx->read_clips(model);
    return;
  }
  for (unsigned a = 0; a < from.scene.mNumAnimations; ++a) {
    const aiAnimation& source = *from.scene.mAnimations[a];
    const double ticks_per_second =
        source.mTicksPerSecond > 0 && std::isfinite(source.mTicksPerSecond) ? source.mTicksPerSecond : 24;
    Clip clip;
    clip.name = source.mName.length > 0 ? source.mName.C_Str() : fmt::format("clip {}", a);

    std::map<int, Channel> channels;  // by node: tracks and weights of one node belong together
    const auto channel_of = [&](int node) -> Channel& {
      Channel& channel = channels[node];
      channel.node = node;
      return channel;
    };
    std::size_t lost = 0;
    for (unsigned c = 0; c < source.mNumChannels; ++c) {
      const aiNodeAnim& motion = *source.mChannels[c];
      const auto node = from.node_ids.find(motion.mNodeName.C_Str());
      if (node == from.node_ids.end()) {
        ++lost;
        continue;
      }
      Channel& channel = channel_of(node->second);
      channel.translation =
          read_keys<glm::dvec3>(motion.mPositionKeys, motion.mNumPositionKeys, ticks_per_second,
                                [](const aiVectorKey& key) { return vec3(key.mValue); });
      channel.rotation = read_keys<glm::dquat>(
          motion.mRotationKeys, motion.mNumRotationKeys, ticks_per_second, [](const aiQuatKey& key) {
            return glm::dquat(static_cast<double>(key.mValue.w), static_cast<double>(key.mValue.x),
                              static_cast<double>(key.mValue.y), static_cast<double>(key.mValue.z));
          });
      channel.scale = read_keys<glm::dvec3>(motion.mScalingKeys, motion.mNumScalingKeys, ticks_per_second,
                                            [](const aiVectorKey& key) { return vec3(key.mValue); });
    }
    for (unsigned c = 0; c < source.mNumMorphMeshChannels; ++c) {
      const aiMeshMorphAnim& motion = *source.mMorphMeshChannels[c];
      const int node = node_of_morph(from, model, motion.mName.C_Str());
      if (node < 0) {
        ++lost;
        continue;
      }
      const std::vector<double>& rest = model.nodes[static_cast<std::size_t>(node)].morph_weights;
      if (!rest.empty()) channel_of(node).morph_weights = read_morph_keys(motion, ticks_per_second, rest);
    }
    if (lost > 0)
      log::warn_once("channels " + from.path.string() + clip.name,
                     fmt::format("{}: {} channels of clip '{}' move nothing that the file has",
                                 from.path.string(), lost, clip.name));

    double last = 0;
    const auto see = [&](const std::vector<double>& times) {
      if (!times.empty()) last = std::max(last, times.back());
    };
    for (auto& [node, channel] : channels) {
      see(channel.translation.times);
      see(channel.rotation.times);
      see(channel.scale.times);
      see(channel.morph_weights.times);
      clip.channels.push_back(std::move(channel));
    }
    const double stated = source.mDuration / ticks_per_second;
    clip.duration = stated > 0 && std::isfinite(stated) ? stated : last;
    model.clips.push_back(std::move(clip));
  }
}

}  // namespace plisse::io
