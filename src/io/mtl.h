// Material libraries of OBJ files (MTL) as plain data.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

namespace plisse::io {

// A picture that a material names, with its options: uv · scale + offset is where it is looked up.
struct MtlPicture {
  std::string name;
  glm::vec2 scale{1}, offset{0};
};

struct MtlMaterial {
  std::string name;
  std::optional<glm::vec3> colour;                     // Kd, as the file writes it
  float opacity = 1;                                   // d, or 1 − Tr
  std::optional<MtlPicture> picture, opacity_picture;  // map_Kd, map_d
};

// Keys may have any case. What would change the picture and is not read (other maps, options of textures)
// gives one warning each. Keys of reflection (Ks, Ns, illum …) are ignored. Throws Error(bad_input) where the
// file cannot be read.
std::vector<MtlMaterial> read_mtl(const std::filesystem::path& path);

}  // namespace plisse::io
