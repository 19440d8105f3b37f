// A solved wrinkle field as a mesh to write: up-sampled, displaced, with normals and texture coordinates.
#pragma once

#include <optional>
#include <string>

#include "cloth/cloth_look.h"
#include "io/mesh_file.h"
#include "wrinkle/upsample.h"

namespace plisse::cloth {

struct WrinkleMesh {
  io::MeshFile file;
  int levels = 0;
};

// Edges are halved `levels` times, or until a wave has eight segments on the longest edge that has waves, but
// with at most a million triangles (a warning says so). Texture coordinates are the look's, or else those of
// the unrolled rest shape. lean: one column a vertex where v₁ is wanted, see wrinkle::leaning. Throws Error.
WrinkleMesh wrinkle_mesh(const std::string& name, const wrinkle::BaseSurface& surface,
                         const wrinkle::CoarseField& field, std::optional<int> levels, bool with_v2,
                         const ClothLook& look = {}, Eigen::Matrix3Xd lean = {});

}  // namespace plisse::cloth
