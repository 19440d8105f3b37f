#include "cloth/cloth_look.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "io/picture/png.h"

namespace plisse::cloth {

ClothLook look_of(const io::Model& model, const Surface& surface, const Cloth& cloth) {
  ClothLook look;
  std::vector<std::uint32_t> part_of(surface.triangle_count(), 0);
  std::map<int, int> pictures;  // texture → picture
  bool uv = false, colours = false, normals = false, holes = false;
  for (const Part& part : surface.parts) {
    if (!part.wrinkles) continue;
    for (std::uint32_t t = 0; t < part.triangle_count; ++t)
      part_of[part.first_triangle + t] = static_cast<std::uint32_t>(look.parts.size());
    uv = uv || part.has_uv;
    colours = colours || part.has_colours;
    ClothLook::Part& own = look.parts.emplace_back(ClothLook::Part{part.mesh, part.material_name});
    if (part.material < 0) continue;
    const io::Material& material = model.materials[static_cast<std::size_t>(part.material)];
    own.base_colour = material.base_colour;
    normals = normals || material.normal_texture >= 0;
    holes = holes || material.alpha == io::Material::Alpha::mask;
    if (material.base_colour_texture < 0 || !part.has_uv) continue;
    const auto [entry, fresh] =
        pictures.try_emplace(material.base_colour_texture, static_cast<int>(look.pictures.size()));
    own.picture = entry->second;
    if (fresh)
      look.pictures.push_back(model.textures[static_cast<std::size_t>(material.base_colour_texture)].image);
  }
  for (const auto& [there, name] :
       {std::pair{colours, "colours of vertices"}, {normals, "normal maps"}, {holes, "cut-outs"}})
    if (there) look.lost.emplace_back(name);
  for (std::size_t f = 0; f < cloth.faces.size(); ++f) {
    const std::uint32_t t = cloth.triangle[f];
    look.part.push_back(part_of[t]);
    if (!uv) continue;
    auto& corners = look.uv.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      const glm::vec2 at = surface.render_vertices[surface.triangles[3 * t + c]].uv;
      corners[c] = Eigen::Vector2d(at.x, at.y);
    }
    if (cloth.turned[f]) std::swap(corners[1], corners[2]);
  }
  return look;
}

std::vector<std::string> write_pictures(const ClothLook& look, const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const io::Image& picture : look.pictures) {
    names.push_back(fmt::format("texture_{}.png", names.size()));
    io::write_png(folder / names.back(), picture, {io::PngLevel::small, ""});
  }
  return names;
}

}  // namespace plisse::cloth
