// Moves the free part of a shell when its held vertices, or the obstacles under it, move: a good start for
// the next equilibrium.
#pragma once

#include <optional>
#include <vector>

#include "shell/statics.h"

namespace plisse::shell {

// The held coordinates at their new values; the others moved by the harmonic extension of the held
// displacements over the rest shape. Coordinates of parts that are not held in that direction do not change.
Positions carried(const Shell& shell, const Conditions& conditions, const Positions& positions);

// For moved obstacles: free vertices move with the obstacle's surface next to them, along its normal, by its
// whole motion m where they touch it and by m/(1 + d/2m) at a distance d, so that the obstacle overtakes
// none. Returns nothing where it would overtake one, or where the surface moves as far as a body is thick:
// then use smaller steps.
std::optional<Positions> followed(const std::vector<Obstacle>& before, const std::vector<Obstacle>& after,
                                  const Conditions& conditions, const Positions& positions);

// The new position of `point` if it moves with the nearest point of an obstacle's surface, for anchors of
// friction. Spheres, capsules, cylinders and planes have only positions: they do not spin.
Eigen::Vector3d carried_along(const Obstacle& before, const Obstacle& after, const Eigen::Vector3d& point);

}  // namespace plisse::shell
