// Wavefront OBJ and MTL, as far as a surface needs them. Our own reader, because a sequence lives from every
// vertex keeping its number over the frames, which general importers do not promise.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "io/import.h"
#include "io/model.h"

namespace plisse::io {

// One OBJ file as it stands there: v, vt, vn, f, o, g, usemtl, mtllib; other lines are passed over.
struct ObjFile {
  struct Corner {
    std::int32_t position = -1, uv = -1, normal = -1;  // from 0; −1 not given
    bool operator==(const Corner&) const = default;
  };
  // Faces from `first_triangle` on belong to this object or group and material, until the next run.
  struct Run {
    std::string name, material;
    std::size_t first_triangle = 0;
  };
  std::filesystem::path path;
  std::vector<glm::dvec3> positions;
  std::vector<glm::vec2> uvs;
  std::vector<glm::vec3> normals;
  std::vector<std::array<Corner, 3>> triangles;  // polygons as fans from their first corner
  std::vector<Run> runs;
  std::vector<std::string> libraries;  // mtllib
};

// Throws Error(bad_input) with file:line for numbers that cannot be read, faces with fewer than three corners
// and indices that point nowhere.
ObjFile read_obj_file(const std::filesystem::path& path);

// A single OBJ: a static model.
Model import_obj(const std::filesystem::path& path, const ImportOptions& options);

}  // namespace plisse::io
