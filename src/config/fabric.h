// Fabrics in files and on the command line: a name of the one table
// (sizing/fabric.h), or numbers.
#pragma once

#include <string>

#include "sizing/fabric.h"
#include "sizing/resolution.h"

namespace plisse::config {

// "khaki", or bending stiffness and Young's modulus, units allowed: "2e-6,3e5", "0.02 gf·cm²/cm,0.3 MPa";
// four of them: weft, then warp. Throws Error(bad_input) that says what was expected.
sizing::Fabric parse_fabric(const std::string& text);

// "Bmin,Bmax,Emin,Emax,rmin,rmax", units allowed. Throws Error(bad_input) likewise.
sizing::FabricRange parse_fabric_range(const std::string& text);

}  // namespace plisse::config
