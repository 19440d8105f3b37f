// Values of animation tracks between their keys, as glTF 2.0 defines them (specification, appendix C): linear
// (spherical for rotations), step, cubic Hermite spline. Before the first and after the last key the value is
// constant.
#pragma once

#include <vector>

#include "io/model.h"

namespace plisse::scene {

// time in seconds; the track must have a key. Rotations come out with length 1 (or non-finite, where a key is
// 0).
glm::dvec3 sample(const io::Keys<glm::dvec3>& track, double time);
glm::dquat sample(const io::Keys<glm::dquat>& track, double time);
std::vector<double> sample(const io::Keys<std::vector<double>>& track, double time);

}  // namespace plisse::scene
