// Where the free part of a shell goes when what is held, or what it lies on, moves: a good start for the next
// equilibrium.
#pragma once

#include <optional>
#include <vector>

#include "shell/statics.h"

namespace plisse::shell {

// The held coordinates in their places; the others moved by the harmonic extension, over the rest shape, of
// how far those had to go. Coordinates of parts that hold none in that direction stay.
Positions carried(const Shell& shell, const Conditions& conditions, const Positions& positions);

// The same obstacles, moved: free vertices go with the surface beside them, by all of its motion m along its
// normal where they touch it and by m/(1 + d/2m) at a distance d, so that none is caught up. Nothing where
// some would be, or where the surface moves as far as a body is thick: take a shorter way.
std::optional<Positions> followed(const std::vector<Obstacle>& before, const std::vector<Obstacle>& after,
                                  const Conditions& conditions, const Positions& positions);

// Where the point of an obstacle's surface next to `point` has gone with it, seen from `point`: what sticks
// to it goes along. Spheres, capsules, cylinders and planes are known by their places alone: they do not
// spin.
Eigen::Vector3d carried_along(const Obstacle& before, const Obstacle& after, const Eigen::Vector3d& point);

}  // namespace plisse::shell
