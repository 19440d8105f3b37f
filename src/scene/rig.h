// The nodes of a model and the clip that moves them.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "io/model.h"

namespace plisse::scene {

class Rig {
 public:
  // Copies the data that it needs; `clip` may be null.
  Rig(const io::Model& model, const io::Clip* clip);

  // World matrix of every node in the clip, or without motion (metres).
  std::vector<glm::dmat4> world(double time) const;
  std::vector<glm::dmat4> world_at_default() const;

  // Morph weights of a node's meshes.
  std::vector<double> morph_weights(int node, double time) const;
  const std::vector<double>& default_morph_weights(int node) const;

  // The node itself or its nearest ancestor that the clip moves; −1 where there is none.
  int moving_ancestor(int node) const;

 private:
  // A node's own matrix as translation, rotation and scale, for channels that animate only some of these.
  struct Parts {
    glm::dvec3 translation{0};
    glm::dquat rotation{1, 0, 0, 0};
    glm::dvec3 scale{1};
  };
  static Parts take_apart(const glm::dmat4& local);
  glm::dmat4 local(std::size_t node, double time) const;

  std::vector<io::Node> nodes_;
  std::vector<io::Channel> channels_;
  std::vector<int> channel_of_;  // per node, −1 none
  std::vector<Parts> parts_;     // per node
};

}  // namespace plisse::scene
