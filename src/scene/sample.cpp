// Sampling of animation tracks (see sample.h).
#include "scene/sample.h"

#include <algorithm>

namespace plisse::scene {
namespace {

// The position of a time: between keys `before` and `before + 1`, at the fraction `part`; part is 0 on keys
// and outside them.
struct Place {
  std::size_t before = 0;
  double part = 0;
  double length = 0;  // seconds from key to key
};

Place find(const std::vector<double>& times, double time) {
  if (!(time > times.front())) return {0, 0, 0};
  if (time >= times.back()) return {times.size() - 1, 0, 0};
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  const auto before = static_cast<std::size_t>(after - times.begin()) - 1;
  const double length = times[before + 1] - times[before];
  return {before, (time - times[before]) / length, length};
}

// p(s) = (2s³−3s²+1)p₀ + d(s³−2s²+s)m₀ + (−2s³+3s²)p₁ + d(s³−s²)m₁, m₀ the out-tangent, m₁ the next
// in-tangent, both per second, d the seconds between the keys (glTF 2.0, C.5).
struct HermiteWeights {
  double p0, m0, p1, m1;
  explicit HermiteWeights(const Place& at) {
    const double s = at.part;
    const double s2 = s * s;
    const double s3 = s2 * s;
    p0 = 2 * s3 - 3 * s2 + 1;
    m0 = at.length * (s3 - 2 * s2 + s);
    p1 = -2 * s3 + 3 * s2;
    m1 = at.length * (s3 - s2);
  }
};

template <typename Value>
Value hermite(const io::Keys<Value>& track, const Place& at) {
  const HermiteWeights w(at);
  const std::size_t i = at.before;
  return track.values[i] * w.p0 + track.out_tangents[i] * w.m0 + track.values[i + 1] * w.p1 +
         track.in_tangents[i + 1] * w.m1;
}

}  // namespace

glm::dvec3 sample(const io::Keys<glm::dvec3>& track, double time) {
  const Place at = find(track.times, time);
  if (at.part == 0 || track.interpolation == io::Interpolation::step) return track.values[at.before];
  if (track.interpolation == io::Interpolation::cubic_spline) return hermite(track, at);
  return glm::mix(track.values[at.before], track.values[at.before + 1], at.part);
}

glm::dquat sample(const io::Keys<glm::dquat>& track, double time) {
  const Place at = find(track.times, time);
  if (at.part == 0 || track.interpolation == io::Interpolation::step)
    return track.values[at.before] / glm::length(track.values[at.before]);
  if (track.interpolation == io::Interpolation::cubic_spline) {
    const glm::dquat value = hermite(track, at);
    return value / glm::length(value);
  }
  const glm::dquat from = track.values[at.before] / glm::length(track.values[at.before]);
  const glm::dquat to = track.values[at.before + 1] / glm::length(track.values[at.before + 1]);
  const glm::dquat value = glm::slerp(from, to, at.part);  // along the shorter arc
  return value / glm::length(value);
}

std::vector<double> sample(const io::Keys<std::vector<double>>& track, double time) {
  const Place at = find(track.times, time);
  if (at.part == 0 || track.interpolation == io::Interpolation::step) return track.values[at.before];
  std::vector<double> result(track.values[at.before].size());
  const HermiteWeights w(at);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double p0 = track.values[at.before][i];
    const double p1 = track.values[at.before + 1][i];
    result[i] = track.interpolation == io::Interpolation::cubic_spline
                    ? p0 * w.p0 + track.out_tangents[at.before][i] * w.m0 + p1 * w.p1 +
                          track.in_tangents[at.before + 1][i] * w.m1
                    : p0 + (p1 - p0) * at.part;
  }
  return result;
}

}  // namespace plisse::scene
