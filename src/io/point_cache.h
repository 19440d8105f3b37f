// MDD (LightWave) and PC2 (3ds Max) point caches: positions of a mesh's vertices, frame by frame, without the
// mesh.
#pragma once

#include <filesystem>

#include "io/model.h"

namespace plisse::io {

// The frames of a cache for a model that was read already, a frame at a time. The cache counts vertices as
// the model's file does: OBJ and PLY by their own numbers, other formats by the vertices that they are read
// with. Positions are in the model's own unit and axes and go where its nodes put the meshes. Throws
// Error(bad_input) where the file is cut off or longer than it says, is neither MDD nor PC2, or has another
// number of vertices; and where a mesh stands in several places. Frames a second: MDD's times; PC2's step in
// frames of 24 a second.
VertexCache read_point_cache(const std::filesystem::path& path, const Model& model);

}  // namespace plisse::io
