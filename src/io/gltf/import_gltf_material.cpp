// glTF materials and their pictures (glTF 2.0, 3.9 and 3.8; KHR_texture_transform).
#include <fmt/format.h>

#include <cmath>

#include "base/log.h"
#include "io/gltf/import_gltf_parts.h"
#include "io/import_texture.h"

namespace plisse::io {
namespace {

glm::vec4 colour4(const GltfValue& at) {
  const std::vector<double> c = at.numbers(4, {1, 1, 1, 1});
  return {c[0], c[1], c[2], c[3]};
}

// KHR_texture_transform: uv' = translation · rotation · scale · uv, in glTF's own uvs (v down).
GltfUvs uvs_of(const GltfValue& info) {
  GltfUvs result;
  result.set = static_cast<std::size_t>(info["texCoord"].count(0));
  const GltfValue transform = info["extensions"]["KHR_texture_transform"];
  if (!transform) return result;
  const std::vector<double> offset = transform["offset"].numbers(2, {0, 0});
  const std::vector<double> scale = transform["scale"].numbers(2, {1, 1});
  const double angle = transform["rotation"].number(0), c = std::cos(angle), s = std::sin(angle);
  result.set = static_cast<std::size_t>(transform["texCoord"].count(result.set));
  result.transform = glm::dmat3(1, 0, 0, 0, 1, 0, offset[0], offset[1], 1) *
                     glm::dmat3(c, -s, 0, s, c, 0, 0, 0, 1) *
                     glm::dmat3(scale[0], 0, 0, 0, scale[1], 0, 0, 0, 1);
  return result;
}

void warn_unread(const GltfFile& file, std::string_view what) {
  log::warn_once(fmt::format("look {} {}", file.path().string(), what),
                 fmt::format("{}: {} not read", file.path().string(), what));
}

// glTF 2.0, 5.26: the modes other than those that are drawn, which are the specification's own choice.
void warn_of_sampler(GltfFile& file, const GltfValue& texture) {
  if (!texture["sampler"]) return;
  const GltfValue sampler = file.list("samplers").at(texture["sampler"].index(file.list("samplers")));
  constexpr std::uint64_t repeat = 10497, nearest = 9728, linear_mipmap_linear = 9987, linear = 9729;
  if (sampler["wrapS"].count(repeat) != repeat || sampler["wrapT"].count(repeat) != repeat)
    warn_unread(file, "a texture is not to repeat (wrapS, wrapT); it does, as its wrapping is");
  const std::uint64_t small = sampler["minFilter"].count(linear_mipmap_linear);
  if (sampler["magFilter"].count(linear) == nearest || (small != linear_mipmap_linear && small != linear))
    warn_unread(file, "a texture is not to be smooth (magFilter, minFilter); it is, as its filters are");
}

// Index into model.textures of what a texture reference names; −1 without one, or where it is missing.
int texture_of(GltfFile& file, const GltfValue& info, Texture::Use use, Model& model) {
  if (!info) return -1;
  const GltfValue texture = file.list("textures").at(info["index"].index(file.list("textures")));
  if (!texture["source"]) {
    log::warn_once(
        "texture source " + file.path().string(),
        fmt::format("{}: a texture names no picture of a kind that is read (PNG, JPEG); it is left out",
                    file.path().string()));
    return -1;
  }
  warn_of_sampler(file, texture);
  const std::size_t id = texture["source"].index(file.list("images"));
  const GltfValue image = file.list("images").at(id);
  const std::string name = fmt::format("embedded {}", id);
  if (image["bufferView"]) return load_texture_bytes(file.view(image["bufferView"]), name, use, model);
  if (const auto data = GltfFile::data_of_uri(image["uri"]))
    return load_texture_bytes(*data, name, use, model);
  const std::string uri = image["uri"].text("");
  if (uri.empty()) image.fail("has neither uri nor bufferView");
  return load_texture_file(file.path(), uri, use, model);
}

Material read_material(GltfFile& file, const GltfValue& source, GltfLook& look, Model& model) {
  Material material;
  material.name = source["name"].text("");
  GltfValue surface = source["pbrMetallicRoughness"];
  GltfValue colour = surface["baseColorFactor"], picture = surface["baseColorTexture"];
  if (const GltfValue old = source["extensions"]["KHR_materials_pbrSpecularGlossiness"]) {
    colour = old["diffuseFactor"];
    picture = old["diffuseTexture"];
  }
  material.base_colour = colour4(colour);  // linear already
  look.colour = uvs_of(picture);
  material.base_colour_texture = texture_of(file, picture, Texture::Use::colour, model);
  const GltfValue normal = source["normalTexture"];
  look.normal = normal ? uvs_of(normal) : look.colour;
  material.normal_scale = static_cast<float>(normal["scale"].number(1));
  material.normal_texture = texture_of(file, normal, Texture::Use::normals, model);

  const std::vector<double> emission = source["emissiveFactor"].numbers(3, {0, 0, 0});
  if (emission[0] > 0 || emission[1] > 0 || emission[2] > 0)
    warn_unread(file, fmt::format("material '{}' gives light (emissiveFactor), which is", material.name));
  if (source["extensions"]["KHR_materials_unlit"])
    warn_unread(file, fmt::format("material '{}' is unlit (KHR_materials_unlit), which is", material.name));
  const std::string alpha = source["alphaMode"].text("OPAQUE");
  if (alpha == "MASK")
    material.alpha = Material::Alpha::mask;
  else if (alpha == "BLEND")
    material.alpha = Material::Alpha::blend;
  else if (alpha != "OPAQUE")
    source["alphaMode"].fail(fmt::format("is '{}', must be OPAQUE, MASK or BLEND", alpha));
  material.alpha_cutoff = static_cast<float>(source["alphaCutoff"].number(0.5));
  material.two_sided = source["doubleSided"].truth(false);
  return material;
}

}  // namespace

std::vector<GltfLook> read_gltf_materials(GltfFile& file, Model& model) {
  const GltfValue sources = file.list("materials");
  std::vector<GltfLook> looks(sources.size());
  for (std::size_t m = 0; m < sources.size(); ++m) {
    Material material = read_material(file, sources.at(m), looks[m], model);
    model.materials.push_back(std::move(material));
  }
  return looks;
}

}  // namespace plisse::io
