// PLY (Stanford polygon files), ASCII and binary of either byte order. Our own reader: a sequence lives from
// every vertex keeping its number, and assimp 5.2.5 crashes on damaged files of this kind.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "io/import.h"
#include "io/model.h"

namespace plisse::io {

// What a surface needs of one file; elements and properties of other names are passed over.
struct PlyFile {
  std::vector<glm::dvec3> positions;                    // x, y, z
  std::vector<glm::vec3> normals;                       // nx, ny, nz; or empty
  std::vector<glm::vec2> uvs;                           // s, t or u, v or texture_u, texture_v; or empty
  std::vector<std::array<std::uint32_t, 3>> triangles;  // polygons as fans from their first corner
};

// Throws Error(bad_input) with the file and what is wrong in it: an unknown format or type, a file that ends
// early, numbers that are not finite, faces of fewer than three corners or of vertices that do not exist.
PlyFile read_ply_file(const std::filesystem::path& path);
// The same from memory; `path` is for messages.
PlyFile parse_ply(std::span<const std::uint8_t> bytes, const std::filesystem::path& path);

// A single file: a static model.
Model import_ply(const std::filesystem::path& path, const ImportOptions& options);

}  // namespace plisse::io
