// What the assimp reader takes from an FBX file's own tree instead of from assimp: transforms with all pivots
// and inherit types, curves between keys, weights of shapes, visibility.
#pragma once

#include <assimp/scene.h>

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <unordered_map>
#include <vector>

#include "io/fbx/fbx_curves.h"
#include "io/fbx/fbx_scene.h"
#include "io/model.h"

namespace plisse::io {

class FbxReading {
 public:
  // Null, with one warning, where the file's tree cannot be read or is another than assimp's.
  static std::unique_ptr<FbxReading> read(const std::filesystem::path& path, const aiScene& scene);

  // The object behind one of assimp's nodes; null for the root.
  const FbxObject* model_of(const aiNode& node) const;

  // Translation, rotation and scale to the node's parent. With an inherit type other than RSrs that is the
  // parent without its scale (`parent_unscaled`), for which such children need a node of its own.
  struct Parts {
    glm::dvec3 translation{0};
    glm::dquat rotation{1, 0, 0, 0};
    glm::dvec3 scale{1};
  };
  Parts parts(const FbxObject& model, const FbxTake* take, double time, bool from_left) const;
  bool parent_unscaled(const FbxObject& model) const;
  bool needs_unscaled(const FbxObject& model) const;  // one of its children is parent_unscaled
  bool visible(const FbxObject& model) const;

  // Where in Model::nodes a model has its turn and its scale; both are one where nothing needs the former.
  struct Place {
    int turned = -1, scaled = -1;
  };
  void place(const FbxObject& model, Place place) { places_[model.id] = place; }
  // The weights of a mesh's targets; empty where the tree has others than the mesh.
  std::vector<double> weights(const FbxObject& model, std::size_t targets, const FbxTake* take, double time,
                              bool from_left) const;
  // The targets of a mesh whose shapes assimp has lost (it does not read those without normals): empty where
  // there are none, or where the tree's corners are not the mesh's.
  std::vector<MorphTarget> lost_targets(const aiNode& holder, unsigned mesh, const aiMesh& source) const;
  void read_clips(Model& model) const;

 private:
  explicit FbxReading(std::string bytes) : scene_(std::move(bytes)) {}
  bool match(const aiNode& node, std::int64_t id, int depth);
  const FbxObject* parent(const FbxObject& model) const;
  glm::dvec3 property(const FbxObject& model, std::string_view name, const glm::dvec3& otherwise,
                      const FbxTake* take, double time, bool from_left) const;
  glm::dvec3 whole_scale(const FbxObject& model, const FbxTake* take, double time, bool from_left,
                         int depth) const;
  std::vector<double> knots(const FbxObject& model, const FbxTake& take) const;
  void add_channel(const FbxObject& model, const FbxTake& take, Clip& clip) const;
  void add_weights(const FbxTake& take, Model& model, Clip& clip) const;
  void tell(const std::filesystem::path& path) const;

  FbxScene scene_;
  std::vector<FbxTake> takes_;
  std::unordered_map<const aiNode*, const FbxObject*> models_;
  std::unordered_map<std::int64_t, Place> places_;
};

}  // namespace plisse::io
