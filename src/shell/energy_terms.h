// The list of a shell's energies. A new one is a file term_NAME.cpp and a line in each of the two places
// below.
#pragma once

#include <memory>

#include "shell/energy_term.h"

namespace plisse::shell {

// Nothing where a shell and its loads have no such energy.
using MakeTerm = std::unique_ptr<EnergyTerm>(const TermInput&);
MakeTerm stretching_term;
MakeTerm midedge_bending_term;
MakeTerm quadratic_bending_term;
MakeTerm dead_loads_term;
MakeTerm contact_term;  // and friction
MakeTerm pressure_term;

// In the order in which they are summed (which rounding depends on, and nothing else).
inline constexpr MakeTerm* energy_terms[] = {
    stretching_term,         // of faces
    midedge_bending_term,    // of faces with flaps
    quadratic_bending_term,  // of the shell
    dead_loads_term,         // of vertices
    contact_term,            // of vertices
    pressure_term,           // of the shell
};

}  // namespace plisse::shell
