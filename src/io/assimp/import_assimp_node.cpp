// The assimp reader's nodes.
//
// assimp takes an FBX node with pivots apart into a chain X_$AssimpFbx$_Translation, …_PreRotation, …, X.
// In 5.2.5 the animation channel of X nonetheless holds the whole motion, pre-rotation included, so that the
// chain would be counted twice; and the offset matrices of a skin lack the geometric transform of its mesh
// (the file's cluster matrices do, and the FBX SDK's own example multiplies it in). So chains are put
// together here: all but the geometric parts go into X, the geometric ones go to X's meshes alone. A chain
// whose single parts have channels is left as it is.
#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <string_view>
#include <unordered_set>

#include "base/log.h"
#include "io/assimp/import_assimp_parts.h"

namespace plisse::io {
namespace {

constexpr std::string_view chain_mark = "_$AssimpFbx$_";

std::string_view name_of(const aiNode& node) {
  return {node.mName.data, node.mName.length};
}

// "X" of a chain's node, empty for other nodes.
std::string_view chain_owner(std::string_view name) {
  const std::size_t mark = name.find(chain_mark);
  return mark == std::string_view::npos ? std::string_view{} : name.substr(0, mark);
}

class NodeReader {
 public:
  NodeReader(AssimpScene& from, Model& model) : from_(from), model_(model) {
    for (unsigned a = 0; a < from.scene.mNumAnimations; ++a)
      for (unsigned c = 0; c < from.scene.mAnimations[a]->mNumChannels; ++c) {
        const aiString& name = from.scene.mAnimations[a]->mChannels[c]->mNodeName;
        const std::string_view owner = chain_owner({name.data, name.length});
        if (!owner.empty()) moving_chains_.emplace(owner);
      }
  }

  // `before` and `geometric`: what the chain above has gathered for this node.
  void read(const aiNode& node, int parent, const glm::dmat4& before, const glm::dmat4& geometric) {
    const std::string_view name = name_of(node);
    const std::string_view owner = chain_owner(name);
    const glm::dmat4 own = mat4(node.mTransformation);
    if (!owner.empty() && (from_.fbx != nullptr || !moving_chains_.contains(std::string(owner)))) {
      const std::string_view part = name.substr(owner.size() + chain_mark.size());
      const bool is_geometric = part.starts_with("Geometric");
      // The inverses keep the geometric parts from the children, who never get them here.
      const bool is_inverse = part.ends_with("Inverse");
      const int unscaled = parent_unscaled_;
      for (unsigned c = 0; c < node.mNumChildren; ++c) {
        parent_unscaled_ = unscaled;
        read(*node.mChildren[c], parent, is_geometric ? before : before * own,
             is_geometric && !is_inverse ? geometric * own : geometric);
      }
      return;
    }
    const FbxObject* in_file = from_.fbx == nullptr ? nullptr : from_.fbx->model_of(node);
    int unscaled = -1;  // for children that do not inherit the scale as it is
    glm::dmat4 local = before * own;
    if (in_file != nullptr) {
      if (from_.fbx->parent_unscaled(*in_file)) parent = parent_unscaled_;
      const FbxReading::Parts parts = from_.fbx->parts(*in_file, nullptr, 0, false);
      const glm::dmat4 turned =
          glm::translate(glm::dmat4{1}, parts.translation) * glm::mat4_cast(parts.rotation);
      local = glm::scale(turned, parts.scale);
      if (from_.fbx->needs_unscaled(*in_file)) {
        unscaled = static_cast<int>(model_.nodes.size());
        Node& turning = model_.nodes.emplace_back();
        turning.name = std::string(node.mName.C_Str()) + " (unscaled)";
        turning.parent = parent;
        turning.local = turned;
        parent = unscaled;
        local = glm::scale(glm::dmat4{1}, parts.scale);
      }
    }
    const int id = static_cast<int>(model_.nodes.size());
    if (in_file != nullptr) from_.fbx->place(*in_file, {unscaled >= 0 ? unscaled : id, id});
    Node& made = model_.nodes.emplace_back();
    made.name = node.mName.C_Str();
    made.parent = parent;
    made.local = local;
    from_.ids[&node] = id;
    if (geometric != glm::dmat4{1}) from_.geometric[&node] = geometric;
    if (!from_.node_ids.emplace(made.name, id).second && !made.name.empty())
      log::warn_once(
          "node names " + from_.path.string(),
          fmt::format("{}: several nodes are called '{}'; animation and bones go to the first of them",
                      from_.path.string(), made.name));
    for (unsigned c = 0; c < node.mNumChildren; ++c) {
      parent_unscaled_ = unscaled;
      read(*node.mChildren[c], id, glm::dmat4{1}, glm::dmat4{1});
    }
  }

 private:
  AssimpScene& from_;
  Model& model_;
  std::unordered_set<std::string> moving_chains_;
  int parent_unscaled_ = -1;  // of the node whose child is read next
};

void hang(const aiNode& node, const AssimpScene& from, bool show_all, Model& model) {
  for (unsigned c = 0; c < node.mNumChildren; ++c) hang(*node.mChildren[c], from, show_all, model);
  const auto known = from.ids.find(&node);
  if (known == from.ids.end() || node.mNumMeshes == 0) return;
  const FbxObject* in_file = from.fbx == nullptr ? nullptr : from.fbx->model_of(node);
  if (in_file != nullptr && !show_all && !from.fbx->visible(*in_file)) return;
  int id = known->second;
  if (const auto geometric = from.geometric.find(&node); geometric != from.geometric.end()) {
    // Skins ignore their node; for them read_meshes has put the transform into the bones.
    Node holder;
    holder.name = model.nodes[static_cast<std::size_t>(id)].name;
    holder.parent = id;
    holder.local = geometric->second;
    id = static_cast<int>(model.nodes.size());
    model.nodes.push_back(std::move(holder));
  }
  Node& holder = model.nodes[static_cast<std::size_t>(id)];
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const int mesh = node.mMeshes[m] < from.mesh_ids.size() ? from.mesh_ids[node.mMeshes[m]] : -1;
    if (mesh < 0) continue;
    holder.meshes.push_back(mesh);
    const std::size_t targets = model.meshes[static_cast<std::size_t>(mesh)].targets.size();
    if (targets <= holder.morph_weights.size()) continue;
    holder.morph_weights.resize(targets, 0);
    const aiMesh& source = *from.scene.mMeshes[node.mMeshes[m]];
    for (std::size_t t = 0; t < std::min<std::size_t>(targets, source.mNumAnimMeshes); ++t) {
      const double weight = static_cast<double>(source.mAnimMeshes[t]->mWeight);
      // For FBX 5.2.5 writes 1 wherever a channel has one shape, whatever the file says; 0 is what files
      // mean.
      holder.morph_weights[t] = from.kind == FileKind::fbx && weight == 1 ? 0 : weight;
    }
    if (in_file != nullptr)
      if (auto weights = from.fbx->weights(*in_file, targets, nullptr, 0, false); !weights.empty())
        holder.morph_weights = std::move(weights);
  }
}

}  // namespace

void read_nodes(AssimpScene& from, const glm::dmat4& world, Model& model) {
  int root = -1;
  if (world != glm::dmat4{1}) {
    root = 0;
    model.nodes.emplace_back().name = "(world)";
    model.nodes.back().local = world;
  }
  NodeReader(from, model).read(*from.scene.mRootNode, root, glm::dmat4{1}, glm::dmat4{1});
}

void hang_meshes(const AssimpScene& from, Model& model) {
  const std::size_t nodes = model.nodes.size();
  hang(*from.scene.mRootNode, from, false, model);
  const bool shown = std::any_of(model.nodes.begin(), model.nodes.end(),
                                 [](const Node& node) { return !node.meshes.empty(); });
  if (shown || from.fbx == nullptr) return;
  model.nodes.resize(nodes);
  hang(*from.scene.mRootNode, from, true, model);
  log::warn_once("hidden " + from.path.string(),
                 fmt::format("{}: everything in it is hidden; all is shown", from.path.string()));
}

}  // namespace plisse::io
