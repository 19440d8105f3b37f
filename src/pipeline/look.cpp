#include "pipeline/look.h"

#include "base/colour.h"

namespace plisse::pipeline {
namespace {

glm::dvec3 linear(const glm::vec3& srgb) {
  return {srgb_to_linear(static_cast<double>(srgb.r)), srgb_to_linear(static_cast<double>(srgb.g)),
          srgb_to_linear(static_cast<double>(srgb.b))};
}

// Whether any vertex of the part can have waves.
bool wrinkles(const LoadedScene& scene, const Part& part) {
  if (scene.has_field_a_frame()) return true;
  for (std::size_t t = part.first_triangle; t < std::size_t{part.first_triangle} + part.triangle_count; ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = scene.surface().render_vertices[scene.surface().triangles[3 * t + i]].welded;
      if (scene.waves.mask[v] > 0) return true;
      if (!scene.waves.field.empty() && scene.waves.field[t].amplitude[i] > 0) return true;
    }
  }
  return false;
}

}  // namespace

passes::Look look_of(const LoadedScene& scene) {
  const auto& s = scene.settings.shading;
  passes::Look look;
  look.smooth_blend = s.blend == config::Blend::smooth;
  look.full_gradient = s.gradient == config::Gradient::full;
  look.field = !scene.waves.field.empty();
  look.shadows = scene.settings.light.shadows;
  look.ground = scene.settings.output.ground;
  look.wireframe = s.wireframe;
  look.roughness = s.roughness;
  look.cavity = s.cavity;
  look.parallax = s.parallax;
  look.sheen = s.sheen;
  look.background = linear(scene.settings.output.background);
  look.transparent = scene.settings.output.transparent;
  return look;
}

std::vector<passes::DrawPart> draw_parts(const LoadedScene& scene) {
  std::vector<passes::DrawPart> parts;
  for (const Part& part : scene.surface().parts) {
    passes::DrawPart draw;
    draw.first_triangle = part.first_triangle;
    draw.triangle_count = part.triangle_count;
    // A surface without its own material gets the scene's.
    const glm::vec3 plain(linear(scene.settings.shading.colour));
    draw.base_colour = glm::vec4(plain, 1);
    if (part.material >= 0) {
      const io::Material& material = scene.model.materials[static_cast<std::size_t>(part.material)];
      const bool textured = material.base_colour_texture >= 0 && part.has_uv;
      draw.two_sided = material.two_sided;
      draw.texture = textured ? material.base_colour_texture : -1;
      draw.normal_texture = part.has_uv ? material.normal_texture : -1;
      draw.normal_scale = material.normal_scale;
      const bool white = glm::vec3(material.base_colour) == glm::vec3(1);
      if (textured || !white || part.has_colours)
        draw.base_colour = material.base_colour;
      else
        draw.base_colour.a = material.base_colour.a;
      draw.has_alpha = material.alpha == io::Material::Alpha::blend;
      draw.alpha_cutoff = material.alpha == io::Material::Alpha::mask ? material.alpha_cutoff : 0.0F;
    }
    draw.wrinkles = wrinkles(scene, part);
    draw.has_colours = part.has_colours;
    if (part.has_colours && part.material < 0) draw.base_colour = glm::vec4(1);
    parts.push_back(draw);
  }
  return parts;
}

std::vector<std::vector<passes::TextureLevel>> texture_levels(const LoadedScene& scene) {
  std::vector<std::vector<passes::TextureLevel>> all;
  for (const auto& texture : scene.model.textures) {
    all.push_back(passes::mip_levels(texture.image.width, texture.image.height, texture.image.rgba,
                                     texture.use == io::Texture::Use::colour));
  }
  return all;
}

}  // namespace plisse::pipeline
