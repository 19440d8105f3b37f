#include "mesh/corner_field.h"

#include <algorithm>
#include <cmath>

namespace plisse {
namespace {

constexpr std::uint32_t none = LoopLevel::none;

// The gradient of a linear function over a triangle, in its plane; 0 where the triangle has no area. Times
// twice that area in `weight`.
glm::dvec3 gradient(const std::array<glm::dvec3, 3>& x, const std::array<double, 3>& value, double& weight) {
  const glm::dvec3 normal = glm::cross(x[1] - x[0], x[2] - x[0]);
  weight = glm::length(normal);
  if (!(weight > 0)) return glm::dvec3(0);
  const glm::dvec3 opposite = value[0] * (x[2] - x[1]) + value[1] * (x[0] - x[2]) + value[2] * (x[1] - x[0]);
  return glm::cross(normal, opposite) / (weight * weight);
}

}  // namespace

CornerField::CornerField(const LoopLevel& level, std::vector<std::array<double, 3>> values,
                         std::vector<bool> known, double period, const std::vector<double>& trust)
    : values_(std::move(values)), known_(std::move(known)), shift_(level.faces.size()), period_(period) {
  double largest = 0;
  for (const auto& v : values_) largest = std::max({largest, std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  // Fields in files have at least seven digits.
  const double tolerance = 1e-6 * std::max(largest, period);
  const auto multiple = [&](double jump) -> std::optional<double> {
    const double nearest = period > 0 ? period * std::round(jump / period) : 0;
    return std::abs(jump - nearest) <= tolerance ? std::optional(nearest) : std::nullopt;
  };
  for (std::size_t f = 0; f < level.faces.size(); ++f) {
    for (std::size_t s = 0; s < 3; ++s) {
      const std::uint32_t beyond = level.across[f][s];
      if (beyond == none || !known_[f] || !known_[beyond / 3]) continue;
      const std::uint32_t g = beyond / 3, t = beyond % 3, here = level.faces[f][s],
                          there = level.faces[f][(s + 1) % 3];
      const auto first = multiple(values_[f][s] - values_[g][(t + 1) % 3]),
                 second = multiple(values_[f][(s + 1) % 3] - values_[g][t]);
      if (trust.empty())
        shift_[f][s] = first == second ? first : std::nullopt;
      else
        shift_[f][s] = trust[here] >= trust[there] ? first : second;
    }
  }
}

void CornerField::look_around(const LoopLevel& level, std::size_t face, std::size_t place,
                              Neighbourhood& near) const {
  near.vertices.clear();
  near.faces.clear();
  const auto see = [&](std::size_t f, std::size_t at, double shift) {
    near.faces.push_back({static_cast<std::uint32_t>(f), at, shift});
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = level.faces[f][c];
      const bool fresh = std::none_of(near.vertices.begin(), near.vertices.end(),
                                      [&](const Vertex& known) { return known.vertex == v; });
      if (fresh) near.vertices.push_back({v, values_[f][c] + shift});
    }
  };
  see(face, place, 0);
  if (place >= 3) {
    const std::size_t side = place - 3;
    const std::uint32_t beyond = level.across[face][side];
    if (const auto shift = shift_[face][side]) see(beyond / 3, 3 + beyond % 3, *shift);
    return;
  }
  // Around the vertex in both directions: first across the side that leads to it, then across the one that
  // leads away.
  for (const bool to : {true, false}) {
    std::size_t f = face, corner = place;
    double shift = 0;
    for (;;) {
      const std::size_t side = to ? (corner + 2) % 3 : corner;
      const auto step = shift_[f][side];
      if (!step) break;
      shift += *step;
      const std::uint32_t beyond = level.across[f][side];
      f = beyond / 3;
      if (f == face) return;  // once around
      corner = to ? beyond % 3 : (beyond % 3 + 1) % 3;
      see(f, corner, shift);
    }
  }
}

double CornerField::value(const Neighbourhood& near, std::uint32_t vertex, const LoopLevel& level,
                          const std::vector<glm::dvec3>& positions) const {
  for (const Vertex& known : near.vertices)
    if (known.vertex == vertex) return known.value;
  glm::dvec3 slope(0);
  double total = 0;
  for (const Face& face : near.faces) {
    const auto& t = level.faces[face.face];
    double weight = 0;
    const glm::dvec3 own =
        gradient({positions[t[0]], positions[t[1]], positions[t[2]]}, values_[face.face], weight);
    slope += weight * own;
    total += weight;
  }
  const Vertex& from = near.vertices.front();
  return from.value + (total > 0 ? glm::dot(slope / total, positions[vertex] - positions[from.vertex]) : 0);
}

double CornerField::sum(const Neighbourhood& near, const Rows<LoopWeight>& masks, std::uint32_t row,
                        const LoopLevel& level, const std::vector<glm::dvec3>& positions) const {
  double result = 0;
  for (std::uint32_t i = masks.offsets[row]; i < masks.offsets[row + 1]; ++i)
    result += masks.items[i].weight * value(near, masks.items[i].vertex, level, positions);
  return result;
}

CornerField CornerField::refined(const LoopLevel& coarse, const LoopLevel& fine,
                                 const std::vector<glm::dvec3>& positions) const {
  CornerField result;
  result.period_ = period_;
  result.values_.assign(fine.faces.size(), {0, 0, 0});
  result.known_.assign(fine.faces.size(), false);
  result.shift_.resize(fine.faces.size());
  // The six points of each coarse face. All faces of a neighbourhood use the same sum, so that jumps stay
  // exact.
  std::vector<std::array<std::optional<double>, 6>> points(coarse.faces.size());
  Neighbourhood near;
  for (std::size_t f = 0; f < fine.faces.size(); ++f) {
    const std::uint32_t parent = fine.parent[f];
    if (!known_[parent]) continue;
    result.known_[f] = true;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t place = fine.place[f][c];
      if (!points[parent][place]) {
        look_around(coarse, parent, place, near);
        const double here = sum(near, fine.masks, fine.faces[f][c], coarse, positions);
        for (const Face& face : near.faces) points[face.face][face.place] = here - face.shift;
      }
      result.values_[f][c] = *points[parent][place];
    }
  }
  for (std::size_t f = 0; f < fine.faces.size(); ++f) {
    for (std::size_t s = 0; s < 3; ++s) {
      const std::uint32_t beyond = fine.across[f][s];
      if (beyond == none) continue;
      const std::uint32_t parent = fine.parent[f], other = fine.parent[beyond / 3];
      if (parent == other) {
        if (known_[parent]) result.shift_[f][s] = 0;
        continue;
      }
      // A half of one of the parent's sides: the one that its corners lie on.
      const std::size_t a = fine.place[f][s], b = fine.place[f][(s + 1) % 3];
      result.shift_[f][s] = shift_[parent][std::max(a, b) - 3];
    }
  }
  return result;
}

std::vector<std::array<CornerField::Limit, 3>> CornerField::limits(
    const LoopSubdivision& surface, const std::vector<glm::dvec3>& positions) const {
  const LoopLevel& level = surface.levels.back();
  std::vector<std::array<Limit, 3>> result(level.faces.size());
  std::vector<std::array<bool, 3>> done(level.faces.size(), {false, false, false});
  Neighbourhood near;
  for (std::size_t f = 0; f < level.faces.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (!known_[f] || done[f][c]) continue;
      const std::uint32_t v = level.faces[f][c];
      look_around(level, f, c, near);
      Limit here{sum(near, surface.limit, v, level, positions), {}};
      for (std::size_t i = 0; i < 2; ++i) here.along[i] = sum(near, surface.tangents[i], v, level, positions);
      for (const Face& face : near.faces) {
        done[face.face][face.place] = true;
        result[face.face][face.place] = here;
        result[face.face][face.place].value -= face.shift;
      }
    }
  }
  return result;
}

void shut(std::vector<double>& values, const LoopLevel& level, const CornerField& field) {
  for (std::size_t f = 0; f < level.faces.size(); ++f) {
    if (field.known()[f]) continue;
    for (const std::uint32_t v : level.faces[f]) values[v] = 0;
  }
}

bool span(const glm::dvec3& first, const glm::dvec3& second) {
  return glm::length(glm::cross(first, second)) > 1e-9 * (glm::dot(first, first) + glm::dot(second, second));
}

glm::dvec3 gradient(const glm::dvec3& first, const glm::dvec3& second, const CornerField::Limit& limit) {
  const glm::dvec3 n = glm::cross(first, second);
  const double area = glm::length(n);
  return (limit.along[0] * glm::cross(second, n) + limit.along[1] * glm::cross(n, first)) / (area * area);
}

}  // namespace plisse
