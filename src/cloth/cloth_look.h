// What a model's triangles look like, kept with the cloth that is made of them, for the files of its base
// surfaces and waves.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "cloth/cloth_of_surface.h"
#include "io/model.h"

namespace plisse::cloth {

struct ClothLook {
  struct Part {  // a mesh of the model, with one material
    std::string mesh, material;
    glm::vec4 base_colour{1};  // linear
    int picture = -1;          // of `pictures`; −1: none
  };
  std::vector<Part> parts;                         // empty: nothing is known
  std::vector<std::uint32_t> part;                 // of each face
  std::vector<std::array<Eigen::Vector2d, 3>> uv;  // of each face's corners, v upward; empty: none
  std::vector<io::Image> pictures;                 // base colour, sRGB
  std::vector<std::string> lost;  // what files of base surfaces cannot keep, in words: "normal maps"
};

// Of the cloth's faces, their corners in its order.
ClothLook look_of(const io::Model& model, const Surface& surface, const Cloth& cloth);

// Writes the pictures as FOLDER/texture_0.png, … and returns these names. Throws Error(no_output).
std::vector<std::string> write_pictures(const ClothLook& look, const std::filesystem::path& folder);

}  // namespace plisse::cloth
