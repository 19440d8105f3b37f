// World matrices of nodes over time (see rig.h).
#include "scene/rig.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "scene/sample.h"

namespace plisse::scene {

Rig::Rig(const io::Model& model, const io::Clip* clip) : nodes_(model.nodes) {
  channel_of_.assign(nodes_.size(), -1);
  if (clip != nullptr) channels_ = clip->channels;
  for (std::size_t c = 0; c < channels_.size(); ++c)
    channel_of_[static_cast<std::size_t>(channels_[c].node)] = static_cast<int>(c);
  parts_.reserve(nodes_.size());
  for (const io::Node& node : nodes_) parts_.push_back(take_apart(node.local));
}

Rig::Parts Rig::take_apart(const glm::dmat4& local) {
  Parts parts;
  parts.translation = glm::dvec3(local[3]);
  glm::dmat3 linear(local);
  for (int axis = 0; axis < 3; ++axis) parts.scale[axis] = glm::length(linear[axis]);
  // A reflection is put into the scale, so that the rest is a rotation.
  if (glm::determinant(linear) < 0) parts.scale.x = -parts.scale.x;
  for (int axis = 0; axis < 3; ++axis) {
    if (parts.scale[axis] == 0) return parts;  // flat: its rotation cannot be determined
    linear[axis] /= parts.scale[axis];
  }
  parts.rotation = glm::normalize(glm::quat_cast(linear));
  return parts;
}

glm::dmat4 Rig::local(std::size_t node, double time) const {
  if (channel_of_[node] < 0) return nodes_[node].local;
  const io::Channel& channel = channels_[static_cast<std::size_t>(channel_of_[node])];
  if (channel.translation.times.empty() && channel.rotation.times.empty() && channel.scale.times.empty())
    return nodes_[node].local;
  const Parts& own = parts_[node];
  const glm::dvec3 translation =
      channel.translation.times.empty() ? own.translation : sample(channel.translation, time);
  const glm::dquat rotation = channel.rotation.times.empty() ? own.rotation : sample(channel.rotation, time);
  const glm::dvec3 scale = channel.scale.times.empty() ? own.scale : sample(channel.scale, time);
  return glm::scale(glm::translate(glm::dmat4{1}, translation) * glm::mat4_cast(rotation), scale);
}

std::vector<glm::dmat4> Rig::world(double time) const {
  std::vector<glm::dmat4> result(nodes_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const glm::dmat4 own = local(n, time);
    result[n] = nodes_[n].parent < 0 ? own : result[static_cast<std::size_t>(nodes_[n].parent)] * own;
  }
  return result;
}

std::vector<glm::dmat4> Rig::world_at_default() const {
  std::vector<glm::dmat4> result(nodes_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    result[n] = nodes_[n].parent < 0 ? nodes_[n].local
                                     : result[static_cast<std::size_t>(nodes_[n].parent)] * nodes_[n].local;
  return result;
}

std::vector<double> Rig::morph_weights(int node, double time) const {
  const int channel = channel_of_[static_cast<std::size_t>(node)];
  if (channel < 0 || channels_[static_cast<std::size_t>(channel)].morph_weights.times.empty())
    return default_morph_weights(node);
  return sample(channels_[static_cast<std::size_t>(channel)].morph_weights, time);
}

const std::vector<double>& Rig::default_morph_weights(int node) const {
  return nodes_[static_cast<std::size_t>(node)].morph_weights;
}

int Rig::moving_ancestor(int node) const {
  for (int n = node; n >= 0; n = nodes_[static_cast<std::size_t>(n)].parent) {
    const int channel = channel_of_[static_cast<std::size_t>(n)];
    if (channel < 0) continue;
    const io::Channel& motion = channels_[static_cast<std::size_t>(channel)];
    if (!motion.translation.times.empty() || !motion.rotation.times.empty() || !motion.scale.times.empty())
      return n;
  }
  return -1;
}

}  // namespace plisse::scene
