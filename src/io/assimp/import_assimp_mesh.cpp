// The assimp reader's meshes: vertices, bones and morph targets.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/log.h"
#include "io/assimp/import_assimp_parts.h"
#include "io/import_colour.h"
#include "io/influences.h"

namespace plisse::io {
namespace {

// The node a mesh hangs under, for vertices that no bone moves.
const aiNode* node_with(const aiNode& node, unsigned mesh) {
  for (unsigned m = 0; m < node.mNumMeshes; ++m)
    if (node.mMeshes[m] == mesh) return &node;
  for (unsigned c = 0; c < node.mNumChildren; ++c)
    if (const aiNode* found = node_with(*node.mChildren[c], mesh)) return found;
  return nullptr;
}

// Vertices whose bones the file names but does not have follow the nearest vertex that has one: a part of a
// limb should stay with the limb. Few files are like that and few vertices in them; where they are many it is
// not worth it.
void adopt(const std::vector<std::size_t>& orphans, const Mesh& mesh,
           std::vector<std::vector<BoneWeight>>& weights) {
  constexpr std::size_t most_pairs = 100'000'000;
  if (orphans.size() * weights.size() > most_pairs) return;
  const std::vector<std::vector<BoneWeight>> before = weights;
  for (const std::size_t orphan : orphans) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < before.size(); ++v) {
      if (before[v].empty()) continue;
      const double distance = glm::distance(mesh.positions[v], mesh.positions[orphan]);
      if (distance >= least) continue;
      least = distance;
      weights[orphan] = before[v];
    }
  }
}

void read_bones(const AssimpScene& from, unsigned mesh_id, Mesh& mesh) {
  const aiMesh& source = *from.scene.mMeshes[mesh_id];
  if (source.mNumBones == 0) return;
  const aiNode* holder = node_with(*from.scene.mRootNode, mesh_id);
  const auto geometric = from.geometric.find(holder);
  const glm::dmat4 before = geometric == from.geometric.end() ? glm::dmat4{1} : geometric->second;

  std::vector<std::vector<BoneWeight>> weights(mesh.positions.size());
  std::vector<bool> lost(mesh.positions.size(), false);
  std::vector<int> in_file(mesh.positions.size(), 0);  // bones on a vertex, those without a node as well
  for (unsigned b = 0; b < source.mNumBones; ++b) {
    const aiBone& bone = *source.mBones[b];
    const auto node = from.node_ids.find(bone.mName.C_Str());
    if (node == from.node_ids.end())
      log::warn_once(
          "bone nodes " + from.path.string(),
          fmt::format(
              "{}: bone '{}' of mesh '{}' is nowhere in the file; its vertices follow the nearest others",
              from.path.string(), bone.mName.C_Str(), mesh.name));
    for (unsigned w = 0; w < bone.mNumWeights; ++w) {
      const aiVertexWeight& weight = bone.mWeights[w];
      if (weight.mVertexId >= weights.size() || !(weight.mWeight > 0) || !std::isfinite(weight.mWeight))
        continue;
      ++in_file[weight.mVertexId];
      if (node == from.node_ids.end())
        lost[weight.mVertexId] = true;
      else
        weights[weight.mVertexId].push_back(
            {static_cast<std::uint32_t>(mesh.bones.size()), static_cast<double>(weight.mWeight)});
    }
    if (node != from.node_ids.end()) mesh.bones.push_back({node->second, mat4(bone.mOffsetMatrix) * before});
  }
  if (mesh.bones.empty() || weights.empty()) return;

  std::vector<std::size_t> orphans;
  for (std::size_t v = 0; v < weights.size(); ++v)
    if (lost[v] && weights[v].empty()) orphans.push_back(v);
  if (!orphans.empty()) adopt(orphans, mesh, weights);

  std::size_t most = 0, cut = 0, unbound = 0;
  for (const auto& of_vertex : weights) {
    most = std::max(most, of_vertex.size());
    cut += of_vertex.size() > max_influences ? 1 : 0;
    unbound += of_vertex.empty() ? 1 : 0;
  }
  mesh.file_max_influences = *std::max_element(in_file.begin(), in_file.end());
  if (cut > 0)
    log::warn_once(
        "influences " + from.path.string() + mesh.name,
        fmt::format("{}: mesh '{}' has up to {} bones on a vertex; the strongest {} are kept on {} vertices",
                    from.path.string(), mesh.name, most, max_influences, cut));
  const auto own_bone = static_cast<std::uint32_t>(mesh.bones.size());
  if (unbound > 0) {
    const auto id = from.ids.find(holder);
    mesh.bones.push_back({id == from.ids.end() ? 0 : id->second, before});
    log::warn_once("unbound " + from.path.string() + mesh.name,
                   fmt::format("{}: {} vertices of mesh '{}' have no bone; they move with its node",
                               from.path.string(), unbound, mesh.name));
  }
  mesh.influences.reserve(weights.size());
  for (auto& of_vertex : weights) mesh.influences.push_back(strongest(of_vertex, own_bone));
}

void read_targets(const aiMesh& source, Mesh& mesh) {
  for (unsigned t = 0; t < source.mNumAnimMeshes; ++t) {
    const aiAnimMesh& shape = *source.mAnimMeshes[t];
    MorphTarget& target = mesh.targets.emplace_back();
    target.name = shape.mName.C_Str();
    target.position_deltas.assign(mesh.positions.size(), glm::vec3{0});
    if (shape.mVertices == nullptr) continue;  // a target of normals alone moves nothing
    const std::size_t count = std::min<std::size_t>(shape.mNumVertices, mesh.positions.size());
    for (std::size_t v = 0; v < count; ++v)
      target.position_deltas[v] = glm::vec3(vec3(shape.mVertices[v]) - mesh.positions[v]);
  }
}

// As programs show them, so sRGB; white ones say nothing.
void read_colours(const aiMesh& source, Mesh& mesh) {
  if (!source.HasVertexColors(0)) return;
  bool tinted = false;
  mesh.colours.reserve(source.mNumVertices);
  for (unsigned v = 0; v < source.mNumVertices; ++v) {
    const aiColor4D& c = source.mColors[0][v];
    mesh.colours.emplace_back(linear(glm::vec3(c.r, c.g, c.b)), c.a);
    tinted |= mesh.colours.back() != glm::vec4(1);
  }
  if (!tinted) mesh.colours.clear();
}

Mesh read_mesh(const AssimpScene& from, unsigned mesh_id) {
  const aiMesh& source = *from.scene.mMeshes[mesh_id];
  Mesh mesh;
  mesh.name = source.mName.C_Str();
  // Lines and points are left over from Triangulate with fewer than three indices.
  for (unsigned f = 0; f < source.mNumFaces; ++f)
    if (source.mFaces[f].mNumIndices == 3)
      mesh.triangles.insert(mesh.triangles.end(), source.mFaces[f].mIndices, source.mFaces[f].mIndices + 3);
  if (mesh.triangles.empty() || source.mVertices == nullptr) {
    mesh.triangles.clear();
    return mesh;
  }
  mesh.material =
      source.mMaterialIndex < from.scene.mNumMaterials ? static_cast<int>(source.mMaterialIndex) : -1;
  const unsigned count = source.mNumVertices;
  mesh.positions.reserve(count);
  for (unsigned v = 0; v < count; ++v) mesh.positions.push_back(vec3(source.mVertices[v]));
  if (source.HasNormals()) {
    mesh.normals.reserve(count);
    for (unsigned v = 0; v < count; ++v) {
      const glm::dvec3 normal = vec3(source.mNormals[v]);
      const double length = glm::length(normal);
      mesh.normals.emplace_back(length > 0 && std::isfinite(length) ? normal / length : glm::dvec3{0});
    }
  }
  unsigned channel = mesh.material >= 0 ? from.uv_channels[source.mMaterialIndex] : 0;
  if (channel >= AI_MAX_NUMBER_OF_TEXTURECOORDS || !source.HasTextureCoords(channel)) channel = 0;
  if (source.HasTextureCoords(channel)) {
    mesh.uvs.reserve(count);
    for (unsigned v = 0; v < count; ++v)
      mesh.uvs.emplace_back(source.mTextureCoords[channel][v].x, source.mTextureCoords[channel][v].y);
  }
  read_colours(source, mesh);
  read_bones(from, mesh_id, mesh);
  read_targets(source, mesh);
  if (from.fbx != nullptr)
    if (const aiNode* holder = node_with(*from.scene.mRootNode, mesh_id))
      if (auto targets = from.fbx->lost_targets(*holder, mesh_id, source); !targets.empty())
        mesh.targets = std::move(targets);
  return mesh;
}

}  // namespace

void read_meshes(AssimpScene& from, Model& model) {
  from.mesh_ids.assign(from.scene.mNumMeshes, -1);
  for (unsigned m = 0; m < from.scene.mNumMeshes; ++m) {
    Mesh mesh = read_mesh(from, m);
    if (mesh.triangles.empty()) continue;
    from.mesh_ids[m] = static_cast<int>(model.meshes.size());
    model.meshes.push_back(std::move(mesh));
  }
}

}  // namespace plisse::io
