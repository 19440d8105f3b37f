// Where the free part of a shell goes when what is held moves: a good start for the next equilibrium.
#pragma once

#include "shell/statics.h"

namespace plisse::shell {

// The held coordinates in their places; the others moved by the harmonic extension, over the rest shape, of
// how far those had to go. Coordinates of parts that hold none in that direction stay.
Positions carried(const Shell& shell, const Conditions& conditions, const Positions& positions);

}  // namespace plisse::shell
