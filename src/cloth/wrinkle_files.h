// What `plisse wrinkle` writes: fields and their geometry, of one base surface or of a frame.
#pragma once

#include "cloth/wrinkle.h"
#include "cloth/wrinkle_mesh.h"

namespace plisse::cloth {

// Throws Error where an output has an ending that is not supported, or cannot be written.
void check_outputs(const WrinkleRequest& request);

// stopped: why a solver stopped before it had converged, as a comment in a PLY; empty: it converged.
void write_field(const std::filesystem::path& output, const wrinkle::BaseSurface& surface,
                 const wrinkle::CoarseField& field, const Eigen::VectorXd& one_form,
                 const std::string& stopped);

// The waves as geometry, as the request says.
WrinkleMesh mesh_of(const WrinkleRequest& request, const std::vector<wrinkle::FaceForms>& forms,
                    const wrinkle::CoarseField& field);

}  // namespace plisse::cloth
