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
// Zero where no neighbour has a length: M is then the identity.
glm::dmat2 regression_inverse(const glm::dvec2* begin, const glm::dvec2* end) {
  glm::dmat2 s(0.0);
  for (const auto* v = begin; v != end; ++v) s += glm::outerProduct(*v, *v);
  const double trace = s[0][0] + s[1][1];
  return trace > 0 ? glm::inverse(s + glm::dmat2(1e-6 * trace)) : glm::dmat2(0.0);
}

bool starts(const VertexWaves& waves, std::size_t v) {
  return !waves.start_direction.empty() && waves.start_direction[v] != glm::dvec3(0);
}

// q = (t·p, b·p), no longer than .99 (docs/passes.md, "Crush"); φ of a solved field, and whether there is
// one.
glm::vec4 bias_in_frame(const VertexWaves& waves, const RestFrames& frames, std::size_t v) {
  if (waves.bias.empty()) return glm::vec4(0);
  const glm::dvec3 &p = waves.bias[v], &t = frames.tangent[v], &n = frames.normal[v];
  const glm::dvec2 q(glm::dot(t, p), glm::dot(glm::cross(n, t), p));
  const double length = glm::length(q);
  const glm::vec2 cut(length > 0.99 ? q * (0.99 / length) : q);
  return starts(waves, v) ? glm::vec4(cut, waves.start_phase[v], 1) : glm::vec4(cut, 0, 0);
}

// k in the frames, at the beginning.
glm::vec4 first_state(const VertexWaves& waves, const RestFrames& frames, std::size_t v) {
  if (!starts(waves, v)) return glm::vec4(0);
  const glm::dvec3 &k = waves.start_direction[v], &t = frames.tangent[v];
  return {glm::dot(t, k), glm::dot(glm::cross(frames.normal[v], t), k), 0, 0};
}

// W, mask, D of a vertex.
glm::vec4 constants_of(const VertexWaves& waves, const RestFrames& rest, const ModelUnits& units,
                       std::size_t v) {
  const glm::dvec3 &wander = waves.wander[v], &t = rest.tangent[v];
  return {waves.wavelength[v] / units.metres, waves.mask[v], glm::dot(wander, t),
          glm::dot(wander, glm::cross(rest.normal[v], t))};
}

bool has_colours(const Surface& surface) {
  return std::any_of(surface.parts.begin(), surface.parts.end(),
                     [](const Part& part) { return part.has_colours; });
}

std::vector<glm::vec4> field_corners(const std::vector<FieldTriangle>& field, const ModelUnits& units) {
  return mapped(3 * field.size(), [&](std::size_t i) {
    const auto& turns = field[i / 3].turns[i % 3];
    return glm::vec4(turns[0], turns[1], turns[2], field[i / 3].amplitude[i % 3] / units.metres);
  });
}

// Uv as the render vertices of a subdivision have them, normals still without direction.
std::vector<GpuRenderVertex> interpolated_vertices(const Surface& surface, const Subdivision& fine) {
  std::vector<GpuRenderVertex> vertices(fine.vertices.size());
  fine.for_each_point([&](std::size_t t, const FinePoint& point) {
    glm::vec2 uv(0), map(0);
    const glm::vec3 b(point.barycentric());
    for (int c = 0; c < 3; ++c) {
      const RenderVertex& corner =
          surface.render_vertices[surface.triangles[3 * t + static_cast<std::size_t>(c)]];
      uv += b[c] * corner.uv;
      map += b[c] * corner.normal_uv;
    }
    vertices[point.vertex] = {glm::vec4(0, 0, 0, uv.x), glm::vec4(uv.y, map, 0)};
  });
  return vertices;
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
    return constants_of(vertex_waves, rest, units, v);
  }));
  rest_rows = gpu::Buffer(rows);
  biases = gpu::Buffer(mapped(count, [&](std::size_t v) { return bias_in_frame(vertex_waves, rest, v); }));
  if (!vertex_waves.carried.empty())
    carried = gpu::Buffer(mapped(count, [&](std::size_t v) {
      const glm::dvec3 &k = vertex_waves.carried[v], &t = rest.tangent[v];
      const glm::dvec2 flat(glm::dot(t, k), glm::dot(glm::cross(rest.normal[v], t), k));
      return glm::vec2(flat != glm::dvec2(0) ? glm::normalize(flat) : flat);
    }));

  render_vertices = gpu::Buffer(mapped(surface.render_vertices.size(), [&](std::size_t i) {
    const RenderVertex& vertex = surface.render_vertices[i];
    const glm::dvec3 t = rest.tangent[vertex.welded], n = rest.normal[vertex.welded],
                     m = glm::dvec3(vertex.normal);
    return GpuRenderVertex{
        glm::vec4(glm::dot(m, t), glm::dot(m, glm::cross(n, t)), glm::dot(m, n), vertex.uv.x),
        glm::vec4(vertex.uv.y, vertex.normal_uv, 0)};
  }));
  if (has_colours(surface))
    render_colours = gpu::Buffer(mapped(surface.render_vertices.size(),
                                        [&](std::size_t i) { return surface.render_vertices[i].colour; }));
  triangle_corners = gpu::Buffer(mapped(surface.triangles.size(), [&](std::size_t i) {
    return GpuCorner{surface.triangles[i], surface.render_vertices[surface.triangles[i]].welded};
  }));

  if (!vertex_waves.field.empty()) {
    field = gpu::Buffer(field_corners(vertex_waves.field, units));
  }

  positions = gpu::Buffer(count * sizeof(glm::vec4));
  frames = gpu::Buffer(count * 2 * sizeof(glm::vec4));
  world_waves = gpu::Buffer(count * sizeof(glm::vec4));
  states = gpu::Buffer(mapped(count, [&](std::size_t v) { return first_state(vertex_waves, rest, v); }));
  waves = gpu::Buffer(count * sizeof(glm::vec4));
  phases = gpu::Buffer(mapped(count, [&](std::size_t v) {
    if (starts(vertex_waves, v)) return glm::vec2(vertex_waves.start_phase[v], 1);  // set
    return glm::vec2(initial_phase(seed, static_cast<std::uint32_t>(v)), 0);
  }));
  phases_next = gpu::Buffer(count * sizeof(glm::vec2));
  counter = gpu::Buffer(std::vector<std::uint32_t>{0, 0, 1});
}

SurfaceBuffers::SurfaceBuffers(const Surface& surface, const Subdivision& fine)
    : vertex_count(fine.position_count), target_count(0), triangle_count(fine.triangle_count()) {
  // World axes instead of tangent frames: a normal's components are then its coordinates.
  frames = gpu::Buffer(mapped(2 * vertex_count, [](std::size_t i) {
    return i % 2 == 0 ? glm::vec4(0, 0, 1, 0) : glm::vec4(1, 0, 0, 0);
  }));
  triangle_corners = gpu::Buffer(mapped(fine.triangles.size(), [&](std::size_t i) {
    return GpuCorner{fine.triangles[i], fine.vertices[fine.triangles[i]].position};
  }));
  if (has_colours(surface)) {
    std::vector<glm::vec4> colours(fine.vertices.size());
    fine.for_each_point([&](std::size_t t, const FinePoint& point) {
      const glm::vec3 b(point.barycentric());
      glm::vec4& colour = colours[point.vertex] = glm::vec4(0);
      for (int c = 0; c < 3; ++c)
        colour +=
            b[c] * surface.render_vertices[surface.triangles[3 * t + static_cast<std::size_t>(c)]].colour;
    });
    render_colours = gpu::Buffer(colours);
  }
  positions = gpu::Buffer(vertex_count * sizeof(glm::vec4));
  relief = gpu::Buffer(vertex_count * sizeof(glm::vec4));
  render_vertices = gpu::Buffer(interpolated_vertices(surface, fine));
  for (gpu::Buffer* unused : {&offsets, &neighbours, &constants, &waves, &world_waves, &phases, &states})
    *unused = gpu::Buffer(std::size_t{0});
}

void SurfaceBuffers::show(const Subdivision& fine, const DisplacedSurface& displaced) {
  positions.write(mapped(vertex_count, [&](std::size_t i) { return single(displaced.positions[i], 1); }));
  relief.write(mapped(vertex_count, [&](std::size_t i) { return glm::vec4(displaced.relief[i]); }));
  auto vertices = render_vertices.read<GpuRenderVertex>();
  for (std::size_t v = 0; v < vertices.size(); ++v)
    vertices[v].normal_u =
        glm::vec4(glm::vec3(displaced.normals[fine.vertices[v].normal]), vertices[v].normal_u.w);
  render_vertices.write(vertices);
}

bool SurfaceBuffers::any_height() const {
  std::uint32_t any = 0;
  counter.read(&any, sizeof any, 2 * sizeof any);
  return any != 0;
}

void SurfaceBuffers::take_bias(const VertexWaves& given, const RestFrames& rest, const RestFrames& posed,
                               const ModelUnits& units) {
  constants.write(mapped(vertex_count, [&](std::size_t v) { return constants_of(given, rest, units, v); }));
  biases.write(mapped(vertex_count, [&](std::size_t v) { return bias_in_frame(given, posed, v); }));
  states.write(mapped(vertex_count, [&](std::size_t v) { return first_state(given, posed, v); }));
  phases.write(mapped(vertex_count, [&](std::size_t v) {
    return starts(given, v) ? glm::vec2(given.start_phase[v], 1) : glm::vec2(0);
  }));
}

void SurfaceBuffers::carry(const std::vector<FieldTriangle>& of, const ModelUnits& units) {
  field.write(field_corners(of, units));
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
