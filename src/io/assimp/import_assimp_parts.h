// The pieces of the assimp reader, one file each; they read the scene from this struct and fill the Model.
#pragma once

#include <assimp/matrix4x4.h>
#include <assimp/scene.h>
#include <assimp/vector3.h>

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <unordered_map>
#include <vector>

#include "io/fbx/import_fbx.h"
#include "io/model.h"

namespace plisse::io {

enum class FileKind { fbx, collada, x, other };

struct AssimpScene {
  const aiScene& scene;
  FileKind kind;
  std::filesystem::path path;
  std::unordered_map<std::string, int> node_ids;  // first node of each name → index into Model::nodes
  std::unordered_map<const aiNode*, int> ids;     // index into Model::nodes
  // FBX: transforms that apply to a node's meshes but not to its children; only those that are not the
  // identity.
  std::unordered_map<const aiNode*, glm::dmat4> geometric;
  std::vector<int> mesh_ids;          // aiMesh → index into Model::meshes, −1 without triangles
  std::vector<unsigned> uv_channels;  // per aiMaterial: the uv set of its base-colour texture
  FbxReading* fbx = nullptr;          // the file's own tree; null: of another kind, or it cannot be read
};

inline glm::dvec3 vec3(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}
inline glm::dmat4 mat4(const aiMatrix4x4& m) {
  return {
      {m.a1, m.b1, m.c1, m.d1}, {m.a2, m.b2, m.c2, m.d2}, {m.a3, m.b3, m.c3, m.d3}, {m.a4, m.b4, m.c4, m.d4}};
}

// Adds the nodes below a root node with the matrix `world`; fills node_ids, ids and geometric.
void read_nodes(AssimpScene& from, const glm::dmat4& world, Model& model);
// After meshes and nodes have been read: assigns meshes to nodes.
void hang_meshes(const AssimpScene& from, Model& model);
void read_materials(AssimpScene& from, Model& model);  // and textures; fills uv_channels
void read_meshes(AssimpScene& from, Model& model);     // fills mesh_ids; bones need node_ids
void read_clips(const AssimpScene& from, Model& model);

}  // namespace plisse::io
