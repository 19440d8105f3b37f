// The assimp reader's materials and base-colour textures.
#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <fmt/format.h>

#include <span>
#include <string_view>

#include "io/import_assimp_parts.h"
#include "io/import_colour.h"
#include "io/import_texture.h"

namespace plisse::io {
namespace {

// An embedded picture is a whole file (height 0, width its size in bytes) or bare BGRA texels.
int load_embedded(const aiTexture& source, const std::string& name, Model& model) {
  if (source.mHeight == 0)
    return load_texture_bytes(
        std::as_bytes(std::span(reinterpret_cast<const char*>(source.pcData), source.mWidth)), name, model);
  Texture texture;
  texture.name = name;
  texture.image.width = static_cast<int>(source.mWidth);
  texture.image.height = static_cast<int>(source.mHeight);
  const std::size_t count = std::size_t{source.mWidth} * source.mHeight;
  texture.image.rgba.reserve(4 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const aiTexel& texel = source.pcData[i];
    texture.image.rgba.insert(texture.image.rgba.end(), {texel.r, texel.g, texel.b, texel.a});
  }
  model.textures.push_back(std::move(texture));
  return static_cast<int>(model.textures.size()) - 1;
}

int load_texture(const AssimpScene& from, const std::string& name, Model& model) {
  const auto [embedded, id] = from.scene.GetEmbeddedTextureAndIndex(name.c_str());
  if (embedded == nullptr) return load_texture_file(from.path, name, model);
  const std::string key = fmt::format("embedded {}", id);
  for (std::size_t i = 0; i < model.textures.size(); ++i)
    if (model.textures[i].name == key) return static_cast<int>(i);
  return load_embedded(*embedded, key, model);
}

void read_alpha(const aiMaterial& source, FileKind kind, Material& material) {
  aiString mode;
  float value = 1;
  if (kind == FileKind::gltf) {
    if (source.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == aiReturn_SUCCESS) {
      const std::string_view name = mode.C_Str();
      material.alpha = name == "MASK"    ? Material::Alpha::mask
                       : name == "BLEND" ? Material::Alpha::blend
                                         : Material::Alpha::opaque;
    }
    if (source.Get(AI_MATKEY_GLTF_ALPHACUTOFF, value) == aiReturn_SUCCESS) material.alpha_cutoff = value;
    return;
  }
  // Programs disagree whether 0 means clear or solid; a material that nobody could see is not what they
  // meant.
  if (source.Get(AI_MATKEY_OPACITY, value) == aiReturn_SUCCESS && value > 0 && value < 1) {
    material.base_colour.a = value;
    material.alpha = Material::Alpha::blend;
  }
}

Material read_material(const AssimpScene& from, const aiMaterial& source, unsigned& uv_channel,
                       Model& model) {
  Material material;
  material.name = source.GetName().C_Str();

  aiColor4D colour;
  if (from.kind == FileKind::gltf && (source.Get(AI_MATKEY_BASE_COLOR, colour) == aiReturn_SUCCESS ||
                                      source.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS))
    material.base_colour = {colour.r, colour.g, colour.b, colour.a};  // glTF factors are linear
  else if (source.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS)
    material.base_colour = {linear(glm::vec3(colour.r, colour.g, colour.b)), 1};
  read_alpha(source, from.kind, material);

  // Only glTF states single-sidedness; elsewhere the key is a reader's default or absent.
  int two_sided = 1;
  if (from.kind == FileKind::gltf && source.Get(AI_MATKEY_TWOSIDED, two_sided) == aiReturn_SUCCESS)
    material.two_sided = two_sided != 0;

  for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
    aiString name;
    if (source.GetTexture(type, 0, &name) != aiReturn_SUCCESS || name.length == 0) continue;
    int channel = 0;
    if (source.Get(AI_MATKEY_UVWSRC(type, 0), channel) == aiReturn_SUCCESS && channel >= 0)
      uv_channel = static_cast<unsigned>(channel);
    material.base_colour_texture = load_texture(from, name.C_Str(), model);
    // In FBX and COLLADA a texture takes the place of the colour, in glTF and X it is multiplied by it.
    if (material.base_colour_texture >= 0 && (from.kind == FileKind::fbx || from.kind == FileKind::collada))
      material.base_colour = {1, 1, 1, material.base_colour.a};
    break;
  }
  return material;
}

}  // namespace

void read_materials(AssimpScene& from, Model& model) {
  from.uv_channels.assign(from.scene.mNumMaterials, 0);
  for (unsigned m = 0; m < from.scene.mNumMaterials; ++m) {
    Material material = read_material(from, *from.scene.mMaterials[m], from.uv_channels[m], model);
    model.materials.push_back(std::move(material));
  }
}

}  // namespace plisse::io
