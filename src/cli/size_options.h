// Fabrics on the command line.
#pragma once

#include <string>

#include "sizing/fabric.h"
#include "sizing/resolution.h"

namespace plisse::cli {

// "B,E", "Bweft,Eweft,Bwarp,Ewarp" with units where one likes, or a name. Throws Error(bad_input).
sizing::Fabric fabric_option(const std::string& text);

// "Bmin,Bmax,Emin,Emax,rmin,rmax", r as lengths; "": the paper's. Throws Error(bad_input).
sizing::FabricRange range_option(const std::string& text);

}  // namespace plisse::cli
