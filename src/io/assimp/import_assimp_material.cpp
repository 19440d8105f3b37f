// The assimp reader's materials and base-colour textures.
#include <assimp/material.h>
#include <fmt/format.h>

#include <span>
#include <string_view>

#include "io/assimp/import_assimp_parts.h"
#include "io/import_colour.h"
#include "io/import_texture.h"

namespace plisse::io {
namespace {

// An embedded picture is a whole file (height 0, width its size in bytes) or bare BGRA texels.
int load_embedded(const aiTexture& source, const std::string& name, Texture::Use use, Model& model) {
  if (source.mHeight == 0)
    return load_texture_bytes(
        std::as_bytes(std::span(reinterpret_cast<const char*>(source.pcData), source.mWidth)), name, use,
        model);
  Texture texture;
  texture.name = name;
  texture.use = use;
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

int load_texture(const AssimpScene& from, const std::string& name, Texture::Use use, Model& model) {
  const auto [embedded, id] = from.scene.GetEmbeddedTextureAndIndex(name.c_str());
  if (embedded == nullptr) return load_texture_file(from.path, name, use, model);
  const std::string key = fmt::format("embedded {}", id);
  for (std::size_t i = 0; i < model.textures.size(); ++i)
    if (model.textures[i].name == key && model.textures[i].use == use) return static_cast<int>(i);
  return load_embedded(*embedded, key, use, model);
}

void read_alpha(const aiMaterial& source, Material& material) {
  float value = 1;
  // Programs disagree whether 0 means clear or solid; an invisible material is not what they
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
  if (source.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS)
    material.base_colour = {linear(glm::vec3(colour.r, colour.g, colour.b)), 1};
  read_alpha(source, material);

  // Of these formats none states single-sidedness: AI_MATKEY_TWOSIDED is a reader's default or absent.
  for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
    aiString name;
    if (source.GetTexture(type, 0, &name) != aiReturn_SUCCESS || name.length == 0) continue;
    int channel = 0;
    if (source.Get(AI_MATKEY_UVWSRC(type, 0), channel) == aiReturn_SUCCESS && channel >= 0)
      uv_channel = static_cast<unsigned>(channel);
    material.base_colour_texture = load_texture(from, name.C_Str(), Texture::Use::colour, model);
    // In FBX and COLLADA a texture takes the place of the colour, in X it is multiplied by it.
    if (material.base_colour_texture >= 0 && (from.kind == FileKind::fbx || from.kind == FileKind::collada))
      material.base_colour = {1, 1, 1, material.base_colour.a};
    break;
  }
  // Not aiTextureType_HEIGHT, where files keep heights in grey.
  aiString normals;
  if (source.GetTexture(aiTextureType_NORMALS, 0, &normals) == aiReturn_SUCCESS && normals.length > 0)
    material.normal_texture = load_texture(from, normals.C_Str(), Texture::Use::normals, model);
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
