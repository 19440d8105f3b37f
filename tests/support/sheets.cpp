#include "support/sheets.h"

#include <cmath>
#include <numbers>
#include <random>

namespace plisse::test {

Sheet sheet(const std::vector<glm::dvec3>& points, const std::vector<std::uint32_t>& triangles, double W) {
  Sheet result;
  Surface& surface = result.surface;
  const std::size_t count = points.size();
  surface.bind = surface.rest = points;
  surface.bind_normal.assign(count, glm::dvec3(0, 0, 1));
  PaletteInfluences one;
  one.weight[0] = 1;
  surface.influences.assign(count, one);
  for (std::size_t v = 0; v < count; ++v) {
    surface.render_vertices.push_back({static_cast<std::uint32_t>(v), glm::vec2(points[v]), {0, 0, 1}});
  }
  surface.triangles = triangles;
  surface.parts.push_back({"sheet", "", -1, 0, static_cast<std::uint32_t>(triangles.size() / 3), true, true});
  build_adjacency(surface);
  result.rest = rest_frames(surface);
  for (std::size_t v = 0; v < count; ++v) {
    surface.render_vertices[v].normal = glm::vec3(result.rest.normal[v]);
  }
  result.waves = {std::vector<double>(count, W), std::vector<double>(count, 1.0),
                  std::vector<glm::dvec3>(count, glm::dvec3(0))};
  return result;
}

Sheet grid(int columns, int rows, double spacing, double jitter, unsigned seed, double W, int copies) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-jitter, jitter);
  std::vector<glm::dvec3> points;
  std::vector<std::uint32_t> triangles;
  for (int copy = 0; copy < copies; ++copy) {
    const auto first = static_cast<std::uint32_t>(points.size());
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        const double dx = move(random), dy = move(random);
        points.emplace_back(spacing * (i + dx), spacing * (j + dy), 0.0);
      }
    }
    for (int j = 0; j + 1 < rows; ++j) {
      for (int i = 0; i + 1 < columns; ++i) {
        const std::uint32_t a = first + static_cast<std::uint32_t>(j * columns + i), b = a + 1;
        const std::uint32_t c = a + static_cast<std::uint32_t>(columns), d = c + 1;
        triangles.insert(triangles.end(), {a, b, d, a, d, c});
      }
    }
  }
  return sheet(points, triangles, W);
}

std::vector<glm::dvec3> mapped(const Sheet& sheet, const std::function<glm::dvec3(const glm::dvec3&)>& map) {
  std::vector<glm::dvec3> points;
  for (const auto& x : sheet.surface.rest) points.push_back(map(x));
  return points;
}

Passes::Passes(const Sheet& sheet, std::size_t palette_size, std::uint32_t seed)
    : buffers(sheet.surface, sheet.rest, sheet.waves, sheet.units, seed),
      units_(sheet.units),
      skin_(palette_size, sheet.surface.target_count, ""),
      crush_(""),
      relax_("") {}

void Passes::pose(const std::vector<glm::dmat4>& palette, const std::vector<double>& target_weights) {
  std::vector<glm::dmat4> matrices;
  for (const auto& m : palette) matrices.push_back(units_.matrix(m));
  skin_.run(buffers, matrices, target_weights);
}

void Passes::pose(const std::vector<glm::dvec3>& positions) {
  std::vector<glm::vec4> points;
  for (const auto& x : positions) points.emplace_back(glm::vec3(units_.world(x)), 1.0F);
  skin_.run_cache(buffers, points);
}

void Passes::crush(double dead_zone, bool always_set) {
  crush_.run(buffers, dead_zone, always_set);
}

void Passes::relax(const passes::RelaxOptions& options) {
  relax_.run(buffers, options);
}

Readings read(const passes::SurfaceBuffers& buffers) {
  Readings now;
  const auto positions = buffers.positions.read<glm::vec4>(), frames = buffers.frames.read<glm::vec4>();
  const auto waves = buffers.waves.read<glm::vec4>(), world = buffers.world_waves.read<glm::vec4>();
  const auto states = buffers.states.read<glm::vec4>();
  const auto phases = buffers.phases.read<glm::vec2>();
  for (std::size_t v = 0; v < buffers.vertex_count; ++v) {
    now.position.emplace_back(positions[v]);
    now.normal.emplace_back(frames[2 * v]);
    now.tangent.emplace_back(frames[2 * v + 1]);
    now.wave.emplace_back(world[v]);
    now.direction.emplace_back(states[v].x, states[v].y);
    now.height.push_back(static_cast<double>(waves[v].z));
    now.weight.push_back(static_cast<double>(world[v].w));
    now.compression.push_back(static_cast<double>(states[v].z));
    now.phase.push_back(static_cast<double>(phases[v].x));
    now.status.push_back(static_cast<int>(phases[v].y));
  }
  return now;
}

void Passes::set_waves(const std::vector<glm::dvec3>& waves, const std::vector<double>& weights) {
  std::vector<glm::vec4> items;
  for (std::size_t v = 0; v < waves.size(); ++v)
    items.emplace_back(glm::vec3(waves[v]), static_cast<float>(weights[v]));
  buffers.world_waves.write(items);
}

void Passes::set_phases(const std::vector<double>& phases, const std::vector<int>& status) {
  std::vector<glm::vec2> items;
  std::uint32_t fresh = 0;
  for (std::size_t v = 0; v < phases.size(); ++v) {
    items.emplace_back(static_cast<float>(phases[v]), static_cast<float>(status[v]));
    fresh += status[v] == 2 ? 1U : 0U;
  }
  buffers.phases.write(items);
  buffers.counter.write(&fresh, sizeof fresh);
}

double wrap(double turns) {
  return turns - std::ceil(turns - 0.5);
}

double wrap_radians(double radians) {
  constexpr double turn = 2 * std::numbers::pi;
  return turn * wrap(radians / turn);
}

double disagreement(const Readings& now, std::size_t own, std::size_t neighbour) {
  constexpr double turn = 2 * std::numbers::pi;
  const glm::dvec3 middle = 0.5 * (now.position[own] + now.position[neighbour]);
  const double sign = glm::dot(now.wave[own], now.wave[neighbour]) < 0 ? -1 : 1;
  const double there =
      glm::dot(now.wave[neighbour], middle - now.position[neighbour]) + now.phase[neighbour] / turn;
  const double here = glm::dot(now.wave[own], middle - now.position[own]) + now.phase[own] / turn;
  return wrap(sign * there - here);
}

double misfit(const Surface& surface, const Readings& now) {
  double sum = 0, count = 0;
  for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
    for (std::uint32_t i = surface.neighbours.offsets[v]; i < surface.neighbours.offsets[v + 1]; ++i) {
      const std::uint32_t n = surface.neighbours.items[i];
      if (!(now.weight[v] > 0 && now.weight[n] > 0) || now.status[v] != 1 || now.status[n] != 1) continue;
      const double d = disagreement(now, v, n);
      sum += d * d;
      count += 1;
    }
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace plisse::test
