#include "scene/wrinkles.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <queue>
#include <set>

// Without these its functions would be symbols of the library, and clash with those of a user who has it too:
// what is declared static once stays so.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
extern "C" {
static float stb_perlin_noise3(float, float, float, int, int, int);
static float stb_perlin_noise3_seed(float, float, float, int, int, int, int);
static float stb_perlin_ridge_noise3(float, float, float, float, float, float, int);
static float stb_perlin_fbm_noise3(float, float, float, float, float, int);
static float stb_perlin_turbulence_noise3(float, float, float, float, float, int);
static float stb_perlin_noise3_wrap_nonpow2(float, float, float, int, int, int, unsigned char);
}
static float stb_perlin_noise3_internal(float, float, float, int, int, int, unsigned char);
#define STB_PERLIN_IMPLEMENTATION
#include <stb_perlin.h>
#pragma GCC diagnostic pop

#include "base/error.h"
#include "config/suggest.h"

namespace plisse::scene {
namespace {

// In ascending order.
std::vector<std::uint32_t> vertices_of(const Surface& surface, bool wrinkling) {
  std::vector<bool> has(surface.vertex_count(), false);
  for (const Part& part : surface.parts) {
    if (part.wrinkles != wrinkling) continue;
    for (std::size_t i = 3 * std::size_t{part.first_triangle};
         i < 3 * std::size_t{part.first_triangle + part.triangle_count}; ++i) {
      has[surface.render_vertices[surface.triangles[i]].welded] = true;
    }
  }
  std::vector<std::uint32_t> ids;
  for (std::size_t v = 0; v < has.size(); ++v)
    if (has[v]) ids.push_back(static_cast<std::uint32_t>(v));
  return ids;
}

// Distance along edges of the rest pose from the vertices of stiff parts, up to `reach` (Dijkstra).
std::vector<double> distance_from_stiff(const Surface& surface, double reach) {
  std::vector<double> distance(surface.vertex_count(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (std::uint32_t v : vertices_of(surface, false)) {
    distance[v] = 0;
    queue.emplace(0.0, v);
  }
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > distance[v] || d > reach) continue;
    for (std::size_t i = surface.neighbours.offsets[v]; i < surface.neighbours.offsets[v + 1]; ++i) {
      const std::uint32_t n = surface.neighbours.items[i];
      const double further = d + glm::distance(surface.rest[v], surface.rest[n]);
      if (further < distance[n]) {
        distance[n] = further;
        queue.emplace(further, n);
      }
    }
  }
  return distance;
}

// Smooth noise in about −1…1 at a point given in its own correlation lengths.
double noise(const glm::dvec3& x, std::uint32_t seed, int channel) {
  // Gradient noise is 0 on its lattice; the offset keeps vertices of regular meshes away from it.
  const glm::vec3 p(x + glm::dvec3(0.37 + 17.0 * channel, 0.61, 0.83));
  const double value =
      static_cast<double>(stb_perlin_noise3_seed(p.x, p.y, p.z, 0, 0, 0, static_cast<int>(seed & 0xffU)));
  return std::clamp(1.6 * value, -1.0, 1.0);
}

}  // namespace

void select_parts(Surface& surface, const config::WrinkleSettings& settings,
                  const std::vector<std::string>& bodies) {
  std::set<std::string> known;
  for (const Part& part : surface.parts) {
    if (!part.mesh.empty()) known.insert(part.mesh);
    if (!part.material_name.empty()) known.insert(part.material_name);
  }
  const std::vector<std::string> names(known.begin(), known.end());
  for (const auto* list : {&settings.only, &settings.exclude}) {
    for (const std::string& name : *list) {
      if (known.count(name)) continue;
      throw Error(ExitCode::bad_input,
                  fmt::format("'{}' is neither a mesh nor a material of this model{}; there are: {}", name,
                              config::did_you_mean(name, names), fmt::join(names, ", ")));
    }
  }
  const auto named = [](const Part& part, const std::vector<std::string>& list) {
    return std::any_of(list.begin(), list.end(), [&](const std::string& name) {
      return name == part.mesh || name == part.material_name;
    });
  };
  for (Part& part : surface.parts) {
    part.wrinkles = (settings.only.empty() || named(part, settings.only)) && !named(part, settings.exclude) &&
                    !named(part, bodies);
  }
}

double default_wavelength(const Surface& surface) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const auto& x : surface.rest) {
    low = glm::min(low, x);
    high = glm::max(high, x);
  }
  const double diagonal = surface.rest.empty() ? 0 : glm::distance(low, high);
  double sum = 0, count = 0;
  for (std::uint32_t v : vertices_of(surface, true)) {
    for (std::size_t i = surface.neighbours.offsets[v]; i < surface.neighbours.offsets[v + 1]; ++i) {
      sum += glm::distance(surface.rest[v], surface.rest[surface.neighbours.items[i]]);
      count += 1;
    }
  }
  const double mean = count > 0 ? sum / count : diagonal / 40;
  const double wavelength = std::clamp(mean, diagonal / 80, diagonal / 12);
  return wavelength > 0 ? wavelength : 1.0;
}

VertexWaves vertex_waves(const Surface& surface, const config::WrinkleSettings& settings, double wavelength) {
  const std::size_t count = surface.vertex_count();
  VertexWaves waves;
  waves.wavelength.assign(count, wavelength);
  waves.mask.assign(count, settings.strength);
  waves.wander.assign(count, glm::dvec3(0));
  const auto distance = distance_from_stiff(surface, wavelength);
  for (std::size_t v = 0; v < count; ++v) {
    const double s = std::min(distance[v] / wavelength, 1.0);
    waves.mask[v] *= s * s * (3 - 2 * s);
    if (settings.irregularity > 0) {
      const glm::dvec3 x = surface.rest[v] / (3 * wavelength);
      waves.wavelength[v] *= 1 + 0.25 * settings.irregularity * noise(x, settings.seed, 0);
      waves.wander[v] =
          0.25 * settings.irregularity *
          glm::dvec3(noise(x, settings.seed, 1), noise(x, settings.seed, 2), noise(x, settings.seed, 3));
      waves.mask[v] *= 1 + 0.25 * settings.irregularity * noise(x, settings.seed, 4);
    }
  }
  return waves;
}

}  // namespace plisse::scene
