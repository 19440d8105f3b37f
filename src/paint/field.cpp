// From a field of Chen et al., Fine Wrinkling on Coarsely Meshed Thin Shells (2021), height a cos φ, to the
// bias of Loviscach 2006, section 7.
#include "paint/field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/error.h"
#include "mesh/place_index.h"
#include "mesh/weld.h"

namespace plisse::paint {
namespace {

using std::numbers::pi;
constexpr double floor_of_r = 0.05;  // r_min of docs/passes.md
constexpr int gradient_rounds = 12;  // each reduces the error to half or less

double smoothstep(double low, double high, double x) {
  const double s = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

// One edge from a vertex, in one triangle, so that both phases have the same branch.
struct Difference {
  std::uint32_t to = 0;
  glm::dvec3 edge{0};
  double phase = 0;
};

// work(vertex, difference) for all of them.
template <typename Work>
void for_differences(const Surface& surface, const SurfaceField& field, const Work& work) {
  for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
    const auto id = [&](std::size_t c) {
      return surface.render_vertices[surface.triangles[3 * t + c]].welded;
    };
    for (std::size_t c = 0; c < 3; ++c) {
      for (const std::size_t other : {(c + 1) % 3, (c + 2) % 3}) {
        // A phase without amplitude has no meaning.
        if (!(field.amplitude[id(c)] > 0 && field.amplitude[id(other)] > 0)) continue;
        work(id(c), Difference{id(other), surface.rest[id(other)] - surface.rest[id(c)],
                               field.phase[t][other] - field.phase[t][c]});
      }
    }
  }
}

std::vector<std::vector<Difference>> differences(const Surface& surface, const SurfaceField& field) {
  std::vector<std::vector<Difference>> all(surface.vertex_count());
  for_differences(surface, field, [&](std::uint32_t v, const Difference& d) { all[v].push_back(d); });
  return all;
}

}  // namespace

SurfaceField field_on(const Surface& surface, const io::WrinkleField& field, const glm::dmat4& to_world,
                      const std::string& file) {
  const auto bad = [&](const std::string& what) {
    return Error(
        ExitCode::bad_input,
        fmt::format("{}: {}; the model's rest pose has to be the base surface that the field was solved on",
                    file, what));
  };
  const double tolerance = 100 * weld_tolerance(surface.rest);  // texts have six digits
  const PlaceIndex ours(surface.rest);
  const double scale = glm::length(glm::dvec3(to_world[0]));

  SurfaceField result;
  result.amplitude.assign(surface.vertex_count(), -1);
  std::vector<std::uint32_t> counterpart;
  for (std::size_t i = 0; i < field.positions.size(); ++i) {
    const glm::dvec3 x(to_world * glm::dvec4(field.positions[i], 1));
    const auto found = ours.nearest(x, tolerance);
    if (!found) throw bad(fmt::format("its vertex {} is not on the model", i));
    counterpart.push_back(*found);
    result.amplitude[*found] = std::max(result.amplitude[*found], scale * field.amplitude[i]);
  }
  const auto missing =
      std::count_if(result.amplitude.begin(), result.amplitude.end(), [](double a) { return a < 0; });
  if (missing > 0) {
    throw bad(fmt::format("it has {} vertices, {} of the model's {} are not among them",
                          field.positions.size(), missing, surface.vertex_count()));
  }

  std::map<std::array<std::uint32_t, 3>, std::size_t> triangles;  // by their vertices, sorted
  const auto sorted = [](std::array<std::uint32_t, 3> t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  for (std::size_t t = 0; t < field.triangles.size(); ++t) {
    const auto& own = field.triangles[t];
    triangles[sorted({counterpart[own[0]], counterpart[own[1]], counterpart[own[2]]})] = t;
  }
  for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
    std::array<std::uint32_t, 3> ids{};
    for (std::size_t c = 0; c < 3; ++c) ids[c] = surface.render_vertices[surface.triangles[3 * t + c]].welded;
    const auto found = triangles.find(sorted(ids));
    if (found == triangles.end()) throw bad(fmt::format("the model's triangle {} is not among its faces", t));
    const auto& theirs = field.triangles[found->second];
    std::array<double, 3> phase{};
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (counterpart[theirs[k]] == ids[c]) phase[c] = field.phase[found->second][k];
      }
    }
    result.phase.push_back(phase);
  }
  return result;
}

std::vector<glm::dvec3> phase_gradients(const Surface& surface, const RestFrames& rest,
                                        const SurfaceField& field) {
  const auto all = differences(surface, field);
  std::vector<glm::dvec3> gradients(surface.vertex_count(), glm::dvec3(0));
  for (int round = 0; round <= gradient_rounds; ++round) {
    std::vector<glm::dvec3> next(gradients.size(), glm::dvec3(0));
    for (std::size_t v = 0; v < all.size(); ++v) {
      const glm::dvec3 t = rest.tangent[v], b = glm::cross(rest.normal[v], t);
      glm::dmat2 s(0);
      glm::dvec2 right(0);
      for (const Difference& d : all[v]) {
        const glm::dvec2 e(glm::dot(t, d.edge), glm::dot(b, d.edge));
        // Along the edge the phase grows by the mean of both ends' gradients, which are unknown in the first
        // round.
        const double bend = round == 0 ? 0 : 0.5 * glm::dot(gradients[d.to] - gradients[v], d.edge);
        const double weight = 1 / std::max(glm::dot(d.edge, d.edge), 1e-300);
        s += weight * glm::outerProduct(e, e);
        right += weight * (d.phase - bend) * e;
      }
      const double trace = s[0][0] + s[1][1];
      if (!(trace > 0)) continue;
      const glm::dvec2 g = glm::inverse(s + glm::dmat2(1e-9 * trace)) * right;
      next[v] = g.x * t + g.y * b;
    }
    gradients = std::move(next);
  }
  return gradients;
}

double gathered_for(double steepness, double dead_zone) {
  const auto reached = [&](double s) {
    return std::sqrt(s * (2 - s)) / (1 - s) * smoothstep(0.5 * dead_zone, dead_zone, s) * pi / 2;
  };
  double low = 0.5 * dead_zone, high = 1 - floor_of_r;
  if (reached(high) <= steepness) return high;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (reached(middle) < steepness ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void field_as_bias(const Surface& surface, const RestFrames& rest, const SurfaceField& field,
                   double dead_zone, VertexWaves& waves) {
  const std::vector<glm::dvec3> gradients = phase_gradients(surface, rest, field);
  const std::size_t count = surface.vertex_count();
  waves.bias.assign(count, glm::dvec3(0));
  waves.start_direction.assign(count, glm::dvec3(0));
  waves.start_phase.assign(count, 0.0);
  for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = surface.render_vertices[surface.triangles[3 * t + c]].welded;
      waves.start_phase[v] = std::remainder(field.phase[t][c], 2 * pi);
    }
  }
  for (std::size_t v = 0; v < count; ++v) {
    const double omega = glm::length(gradients[v]);
    if (!(omega > 0)) continue;
    const double s = gathered_for(field.amplitude[v] * omega, dead_zone);
    waves.bias[v] = std::sqrt(s) * gradients[v] / omega;
    waves.wavelength[v] = 2 * pi / ((1 - s) * omega);
    waves.start_direction[v] = gradients[v] / omega;
  }
}

std::vector<FieldTriangle> field_directly(const Surface& surface, const RestFrames& rest,
                                          const SurfaceField& field, const std::vector<double>& mask,
                                          std::vector<glm::dvec3> gradients) {
  if (gradients.empty()) gradients = phase_gradients(surface, rest, field);
  std::vector<std::uint8_t> smooth(surface.vertex_count(), 0), torn(surface.vertex_count(), 0);
  for_differences(surface, field, [&](std::uint32_t v, const Difference& d) {
    const double alone = glm::dot(gradients[v], d.edge),
                 reached = 0.5 * (alone + glm::dot(gradients[d.to], d.edge));
    smooth[v] = 1;
    // The mean may be right where both gradients are wrong, against each other.
    if (!(std::abs(reached - d.phase) < pi / 2 && std::abs(alone - d.phase) < pi)) torn[v] = 1;
  });
  for (std::size_t v = 0; v < smooth.size(); ++v) smooth[v] = smooth[v] == 1 && torn[v] == 0 ? 1 : 0;
  std::vector<FieldTriangle> result(surface.triangle_count());
  for (std::size_t t = 0; t < result.size(); ++t) {
    const auto id = [&](std::size_t c) {
      return surface.render_vertices[surface.triangles[3 * t + c]].welded;
    };
    const double whole = std::round(field.phase[t][0] / (2 * pi));
    for (std::size_t j = 0; j < 3; ++j) {
      result[t].amplitude[j] = mask[id(j)] * field.amplitude[id(j)];
      for (std::size_t k = 0; k < 3; ++k) {
        const double phase =
            smooth[id(j)] == 1
                ? field.phase[t][j] + glm::dot(gradients[id(j)], surface.rest[id(k)] - surface.rest[id(j)])
                : field.phase[t][k];
        result[t].turns[j][k] = phase / (2 * pi) - whole;
      }
    }
  }
  return result;
}

std::vector<FieldTriangle> field_of_cloth(const Surface& surface, const SolvedClip& clip, std::size_t index,
                                          const std::vector<double>& mask,
                                          const std::vector<glm::dvec3>& gradients) {
  const SolvedClip::Frame& frame = clip.frames.at(index);
  std::vector<FieldTriangle> result(surface.triangle_count());
  if (frame.amplitude.empty()) return result;
  // The cloth as a surface of its own, whose vertices are not welded where its sheets only touch.
  Surface cloth;
  cloth.rest = frame.base;
  cloth.bind_normal.assign(cloth.rest.size(), glm::dvec3(0, 1, 0));
  std::vector<double> strength;
  for (std::uint32_t v = 0; v < clip.welded.size(); ++v) {
    cloth.render_vertices.push_back({v});
    strength.push_back(mask[clip.welded[v]]);
  }
  for (const auto& face : clip.faces) cloth.triangles.insert(cloth.triangles.end(), face.begin(), face.end());
  if (gradients.empty()) build_adjacency(cloth);  // which only finding them needs
  const std::vector<FieldTriangle> own =
      field_directly(cloth, gradients.empty() ? rest_frames(cloth) : RestFrames{},
                     {frame.amplitude, frame.phase}, strength, gradients);
  for (std::size_t f = 0; f < own.size(); ++f) result[clip.triangle[f]] = own[f];
  return result;
}

}  // namespace plisse::paint
