#include "benchmark/plain_cpp.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace plisse::benchmark {
namespace {

constexpr float two_pi = glm::two_pi<float>();
constexpr float idle = 0, set = 1, fresh = 2;
constexpr float floor_of_r = 0.05F, isotropy = 0.01F;

// To (−½, ½]. The conversion is a quick ceil, which x86-64 lacks before SSE 4.1; turns are far below 2³¹.
float wrap_turns(float x) {
  const float shifted = x - 0.5F;
  const auto whole = static_cast<float>(static_cast<int>(shifted));
  return x - (shifted > whole ? whole + 1 : whole);
}

float smoothstep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

void crush_vertex(PlainSurface& surface, std::size_t v, float dead_zone) {
  const auto& constant = surface.constants[v];
  const glm::vec3 x = surface.positions[v], t = surface.tangents[v], b = glm::cross(surface.normals[v], t);
  // M = [a b; c d] = E + Σ (v' − v)⊗(S + μE)⁻¹v.
  float ma = 1, mb = 0, mc = 0, md = 1;
  for (std::uint32_t i = surface.offsets[v]; i < surface.offsets[v + 1]; ++i) {
    const glm::vec3 edge = surface.positions[surface.neighbours[i]] - x;
    const auto& rest = surface.rest_edges[i];
    const float change_t = glm::dot(t, edge) - rest.edge.x, change_b = glm::dot(b, edge) - rest.edge.y;
    ma += change_t * rest.row.x;
    mb += change_t * rest.row.y;
    mc += change_b * rest.row.x;
    md += change_b * rest.row.y;
  }
  const float determinant = ma * md - mb * mc;
  const float p = std::sqrt((ma + md) * (ma + md) + (mc - mb) * (mc - mb));
  const float q = std::sqrt((ma - md) * (ma - md) + (mb + mc) * (mb + mc));
  const float sigma1 = (p + q) / 2, sigma2 = sigma1 > 0 ? std::abs(determinant) / sigma1 : 0, r = sigma2;

  const float P = (ma * ma + mc * mc - mb * mb - md * md) / 2, Q = ma * mb + mc * md,
              R = std::sqrt(P * P + Q * Q);
  glm::vec2 v1(1, 0);
  if (R > 0) {
    const float larger = std::sqrt((1 + std::abs(P) / R) / 2), other = Q / (2 * R * larger);
    v1 = P >= 0 ? glm::vec2(larger, other) : glm::vec2(std::abs(other), std::copysign(larger, other));
  }
  const glm::vec2 v2(-v1.y, v1.x);
  const float squares = sigma1 * sigma1 + sigma2 * sigma2;
  const float g = squares > 0 ? (sigma1 * sigma1 - sigma2 * sigma2) / squares : 0;

  glm::vec2 k = surface.states[v].direction;
  const glm::vec2 toward = glm::dot(k, v2) < 0 ? -v2 : v2;
  bool has_direction = (k.x != 0 || k.y != 0) && surface.phases[v].status != idle;
  if (has_direction) {
    k = glm::normalize(k + std::min(g / isotropy, 1.0F) * (toward - k));
  } else if (g > isotropy) {
    k = toward;
    has_direction = true;
  }
  const glm::vec2 u1 = sigma1 > 0 ? glm::vec2(ma * v1.x + mb * v1.y, mc * v1.x + md * v1.y) / sigma1 : v1;
  const glm::vec2 u2 = determinant < 0 ? glm::vec2(u1.y, -u1.x) : glm::vec2(-u1.y, u1.x);
  const glm::vec2 wavenumber = (u1 * (glm::dot(v1, k) / std::max(sigma1, floor_of_r)) +
                                u2 * (glm::dot(v2, k) / std::max(sigma2, floor_of_r))) /
                               constant.wavelength;

  const float s = 1 - r;
  const float relative_height = constant.mask * 0.25F * std::sqrt(std::max((1 - r) * (1 + r), 0.0F)) *
                                smoothstep(dead_zone / 2, dead_zone, s);
  const float weight = std::clamp((relative_height - 0.0125F) / 0.0625F, 0.0F, 1.0F);

  float status = surface.phases[v].status;
  const bool can_wave = constant.mask > 0 && has_direction;
  if (status != idle && (!can_wave || s < dead_zone / 2)) {
    status = idle;
  } else if (status == idle && can_wave && s > dead_zone) {
    status = fresh;
  }
  surface.states[v] = {k, s, g};
  surface.waves[v] = {wavenumber, relative_height * constant.wavelength, weight};
  surface.world_wavenumbers[v] = wavenumber.x * t + wavenumber.y * b;
  surface.weights[v] = weight;
  surface.phases[v].status = status;
}

void descend_vertex(PlainSurface& surface, std::size_t v, float step) {
  const auto own = surface.phases[v];
  surface.phases_next[v] = own;
  const std::uint32_t begin = surface.offsets[v], end = surface.offsets[v + 1];
  if (own.status != set || begin == end) return;
  const glm::vec3 x = surface.positions[v], wavenumber = surface.world_wavenumbers[v];
  const float turns = own.phase / two_pi;
  float sum = 0;
  for (std::uint32_t i = begin; i < end; ++i) {
    const std::uint32_t n = surface.neighbours[i];
    if (surface.phases[n].status != set) continue;
    const glm::vec3 other = surface.world_wavenumbers[n];
    const glm::vec3 half_way = (surface.positions[n] - x) * 0.5F;  // p − x'_0; p − x'_n is minus that
    const float sgn = glm::dot(other, wavenumber) < 0 ? -1.0F : 1.0F;
    const float target =
        sgn * (surface.phases[n].phase / two_pi - glm::dot(other, half_way)) - glm::dot(wavenumber, half_way);
    sum += surface.weights[n] * wrap_turns(target - turns);
  }
  surface.phases_next[v].phase = two_pi * wrap_turns(turns + step * sum / static_cast<float>(end - begin));
}

template <typename Function>
void for_all(std::size_t count, bool threads, const Function& function) {
  if (!threads) {
    for (std::size_t v = 0; v < count; ++v) function(v);
    return;
  }
  using Range = tbb::blocked_range<std::size_t>;
  tbb::parallel_for(Range(0, count, 256), [&](const Range& range) {
    for (std::size_t v = range.begin(); v < range.end(); ++v) function(v);
  });
}

template <typename Result, typename Item, typename Function>
std::vector<Result> converted(const std::vector<Item>& items, Function&& function) {
  std::vector<Result> results;
  results.reserve(items.size());
  for (const Item& item : items) results.push_back(function(item));
  return results;
}

}  // namespace

PlainSurface::PlainSurface(const passes::SurfaceBuffers& gpu)
    : offsets(gpu.offsets.read<std::uint32_t>()),
      neighbours(gpu.neighbours.read<std::uint32_t>()),
      rest_edges(gpu.rest_rows.read<RestEdge>()),
      states(gpu.states.read<State>()),
      waves(gpu.waves.read<Wave>()),
      phases(gpu.phases.read<Phase>()),
      phases_next(phases) {
  struct GpuFrame {
    glm::vec4 normal, tangent;
  };
  constants = converted<Constant>(gpu.constants.read<glm::vec4>(), [](const glm::vec4& c) {
    return Constant{c.x, c.y};
  });
  positions =
      converted<glm::vec3>(gpu.positions.read<glm::vec4>(), [](const glm::vec4& x) { return glm::vec3(x); });
  const auto frames = gpu.frames.read<GpuFrame>();
  normals = converted<glm::vec3>(frames, [](const GpuFrame& frame) { return glm::vec3(frame.normal); });
  tangents = converted<glm::vec3>(frames, [](const GpuFrame& frame) { return glm::vec3(frame.tangent); });
  const auto world_waves = gpu.world_waves.read<glm::vec4>();
  world_wavenumbers =
      converted<glm::vec3>(world_waves, [](const glm::vec4& wave) { return glm::vec3(wave); });
  weights = converted<float>(world_waves, [](const glm::vec4& wave) { return wave.w; });
}

void crush(PlainSurface& surface, float dead_zone, bool threads) {
  for_all(surface.size(), threads, [&](std::size_t v) { crush_vertex(surface, v, dead_zone); });
}

void descend(PlainSurface& surface, float epsilon, bool threads) {
  const float step = epsilon / (2 * glm::pi<float>() * glm::pi<float>());
  for_all(surface.size(), threads, [&](std::size_t v) { descend_vertex(surface, v, step); });
  std::swap(surface.phases, surface.phases_next);
}

}  // namespace plisse::benchmark
