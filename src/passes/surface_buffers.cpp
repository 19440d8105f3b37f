#include "passes/surface_buffers.h"

#include <algorithm>

#include <glm/gtc/constants.hpp>

namespace plisse::passes {
namespace {

glm::vec4 single(const glm::dvec3& x, double w = 0) {
  return {glm::vec3(x), static_cast<float>(w)};
}

template <typename Function>
auto mapped(std::size_t count, Function&& function) {
  std::vector<decltype(function(std::size_t{0}))> result(count);
  for (std::size_t i = 0; i < count; ++i) result[i] = function(i);
  return result;
}

struct GpuInfluences {
  std::array<std::uint32_t, 8> entries;
  std::array<float, 8> weights;
};
struct GpuRenderVertex {
  glm::vec4 normal_u, v;
};
struct GpuCorner {
  std::uint32_t render_vertex, welded;
};
struct GpuPlace {
  glm::vec4 point, normal;
};

// (S + μE)⁻¹ with S = Σ v⊗v and μ = 1e-6 trace S, in double precision: it depends on the rest pose alone.
// Zero where no neighbour tells anything: M is then the identity.
glm::dmat2 regression_inverse(const glm::dvec2* begin, const glm::dvec2* end) {
  glm::dmat2 s(0.0);
  for (const auto* v = begin; v != end; ++v) s += glm::outerProduct(*v, *v);
  const double trace = s[0][0] + s[1][1];
  return trace > 0 ? glm::inverse(s + glm::dmat2(1e-6 * trace)) : glm::dmat2(0.0);
}

}  // namespace

float initial_phase(std::uint32_t seed, std::uint32_t vertex) {
  // PCG hash (Jarzynski and Olano 2020, "Hash functions for GPU rendering") of both.
  const auto pcg = [](std::uint32_t x) {
    const std::uint32_t state = x * 747796405U + 2891336453U;
    const std::uint32_t word = ((state >> ((state >> 28U) + 4U)) ^ state) * 277803737U;
    return (word >> 22U) ^ word;
  };
  const double turns = (pcg(vertex + pcg(seed)) + 1.0) / 4294967296.0 - 0.5;  // (−½, ½]
  return static_cast<float>(turns * glm::two_pi<double>());
}

SurfaceBuffers::SurfaceBuffers(const Surface& surface, const RestFrames& rest,
                               const VertexWaves& vertex_waves, const ModelUnits& units, std::uint32_t seed)
    : vertex_count(surface.vertex_count()),
      target_count(surface.target_count),
      triangle_count(surface.triangle_count()) {
  const std::size_t count = vertex_count;
  bind_places = gpu::Buffer(mapped(count, [&](std::size_t v) {
    return GpuPlace{single(units.rest(surface.bind[v]), 1), single(surface.bind_normal[v])};
  }));
  influences = gpu::Buffer(mapped(count, [&](std::size_t v) {
    return GpuInfluences{surface.influences[v].entry, surface.influences[v].weight};
  }));
  target_deltas = gpu::Buffer(mapped(target_count * count, [&](std::size_t i) {
    return single(glm::dvec3(surface.target_deltas[i]) / units.metres);
  }));
  offsets = gpu::Buffer(surface.neighbours.offsets);
  neighbours = gpu::Buffer(surface.neighbours.items);
  corner_offsets = gpu::Buffer(surface.corners.offsets);
  corners = gpu::Buffer(surface.corners.items);
  tangent_neighbours = gpu::Buffer(rest.tangent_neighbour);

  std::vector<glm::vec4> rows(rest.edge.size());
  constants = gpu::Buffer(mapped(count, [&](std::size_t v) {
    const std::size_t begin = surface.neighbours.offsets[v], end = surface.neighbours.offsets[v + 1];
    const glm::dmat2 inverse = regression_inverse(rest.edge.data() + begin, rest.edge.data() + end);
    for (std::size_t i = begin; i < end; ++i) {
      const glm::dvec2 edge = rest.edge[i], row = inverse * edge;  // metres, 1/metres
      rows[i] = glm::vec4(row * units.metres, edge / units.metres);
    }
    const glm::dvec3 wander = vertex_waves.wander[v];
    return glm::vec4(vertex_waves.wavelength[v] / units.metres, vertex_waves.mask[v],
                     glm::dot(wander, rest.tangent[v]),
                     glm::dot(wander, glm::cross(rest.normal[v], rest.tangent[v])));
  }));
  rest_rows = gpu::Buffer(rows);

  render_vertices = gpu::Buffer(mapped(surface.render_vertices.size(), [&](std::size_t i) {
    const RenderVertex& vertex = surface.render_vertices[i];
    const glm::dvec3 t = rest.tangent[vertex.welded], n = rest.normal[vertex.welded],
                     m = glm::dvec3(vertex.normal);
    return GpuRenderVertex{
        glm::vec4(glm::dot(m, t), glm::dot(m, glm::cross(n, t)), glm::dot(m, n), vertex.uv.x),
        glm::vec4(vertex.uv.y, vertex.normal_uv, 0)};
  }));
  if (std::any_of(surface.parts.begin(), surface.parts.end(), [](const Part& p) { return p.has_colours; }))
    render_colours = gpu::Buffer(mapped(surface.render_vertices.size(),
                                        [&](std::size_t i) { return surface.render_vertices[i].colour; }));
  triangle_corners = gpu::Buffer(mapped(surface.triangles.size(), [&](std::size_t i) {
    return GpuCorner{surface.triangles[i], surface.render_vertices[surface.triangles[i]].welded};
  }));

  positions = gpu::Buffer(count * sizeof(glm::vec4));
  frames = gpu::Buffer(count * 2 * sizeof(glm::vec4));
  world_waves = gpu::Buffer(count * sizeof(glm::vec4));
  states = gpu::Buffer(count * sizeof(glm::vec4));
  waves = gpu::Buffer(count * sizeof(glm::vec4));
  phases = gpu::Buffer(mapped(count, [&](std::size_t v) {
    return glm::vec2(initial_phase(seed, static_cast<std::uint32_t>(v)), 0);
  }));
  phases_next = gpu::Buffer(count * sizeof(glm::vec2));
  counter = gpu::Buffer(sizeof(std::uint32_t));
}

void SurfaceBuffers::bind_for_reading() const {
  using Item = gpu::Buffer::Item;
  positions.bind_items(8, Item::vec4);
  frames.bind_items(9, Item::vec4);
  offsets.bind_items(10, Item::uint);
  neighbours.bind_items(11, Item::uint);
  constants.bind_items(12, Item::vec4);
  waves.bind_items(13, Item::vec4);
  world_waves.bind_items(14, Item::vec4);
  bind_phases_for_reading();
  states.bind_items(16, Item::vec4);
}

void SurfaceBuffers::bind_phases_for_reading() const {
  phases.bind_items(15, gpu::Buffer::Item::vec2);
}

}  // namespace plisse::passes
