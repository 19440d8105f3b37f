// The rules by which a pose's normals and tangents are made, one vertex at a time (docs/passes.md, "Skin").
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "mesh/surface.h"

namespace plisse {

// Unit sum of the corner cross products around a vertex, or `fallback` where they cancel. Needs
// surface.corners; positions: one per welded vertex, any unit.
glm::dvec3 area_normal(const Surface& surface, const std::vector<glm::dvec3>& positions, std::size_t vertex,
                       const glm::dvec3& fallback);

// The coordinate axis with the smallest |component| of the unit normal (the first on ties), made
// perpendicular to it.
glm::dvec3 any_perpendicular(const glm::dvec3& normal);

// Unit tangential part of an edge, or any_perpendicular where the edge has none.
glm::dvec3 tangent_along(const glm::dvec3& edge, const glm::dvec3& normal);

}  // namespace plisse
