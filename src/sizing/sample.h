// Vertices for a panel: along its lines, then Poisson-disk samples between them (D. Zhang et al., SIGGRAPH
// 2025, 4.3).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <vector>

#include "sizing/domain.h"
#include "sizing/size_map.h"

namespace plisse::sizing {

// Vertices per ∫dA/r² of a mesh of equilateral triangles with edges r: two triangles a vertex, √3/4 r² each.
inline constexpr double vertex_density = 1.1547005383792515;  // 2/√3

// The least distance of two samples over r that gives this number: random packings of discs are full at a
// covered share of 0.547 (J. Feder 1980), so at 0.547 · 4/π samples per squared least distance; with 2/√3 per
// squared edge this is √(0.6965 √3/2).
inline constexpr double least_distance = 0.7766;

struct Samples {
  std::vector<glm::dvec2> points;  // working coordinates; those on lines first
  std::vector<std::vector<std::uint32_t>>
      lines;  // by line of the domain: its samples in order; closed: first again last
  std::size_t on_lines = 0;
};

// The points that divide a line evenly by ∫ds/r: shares of its length in panel coordinates, between 0 and 1,
// ascending. For lines that are not closed.
std::vector<double> line_division(const Domain& domain, const SizeMap& map, std::size_t line);

// Lines in `divisions` are divided at these shares of their lengths in panel coordinates, others evenly by
// ∫ds/r; ends are always samples.
using Divisions = std::map<std::size_t, std::vector<double>>;
Samples sample_lines(const Domain& domain, const SizeMap& map, const Divisions& divisions = {});

// Adds the interior: R. Bridson's sampling ("Fast Poisson Disk Sampling in Arbitrary Dimensions", 2007) with
// r from the map. The same seed gives the same points.
void sample_interior(const Domain& domain, const SizeMap& map, std::uint32_t seed, Samples& samples);

// The number of vertices of an ideal mesh with edges r: Euler's formula with equilateral triangles gives
// (2/√3) ∫dA/r² + ½ ∮ds/r + 1 − holes, and every vertex on the lines beside a fold besides.
double expected_vertices(const Domain& domain, const SizeMap& map, const Samples& samples);

}  // namespace plisse::sizing
