// The objects of an FBX file, their properties (with those of their class's template) and what is connected
// to what.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "io/fbx/fbx_tree.h"

namespace plisse::io {

struct FbxObject {
  std::int64_t id = 0;
  std::string_view kind;  // "Model", "Geometry", "Deformer", …: the element's name
  std::string_view name;  // without "Model::"
  std::string_view type;  // "Mesh", "Cluster", "BlendShapeChannel", …
  const FbxElement* element = nullptr;
};

class FbxScene {
 public:
  explicit FbxScene(std::string bytes);  // throws as FbxTree does

  const FbxTree& tree() const { return tree_; }
  const std::vector<FbxObject>& objects() const { return objects_; }  // in the file's order
  const FbxObject* object(std::int64_t id) const;                     // null where there is none
  double ticks_per_second() const { return ticks_per_second_; }

  // A property's element, of the object itself or of its class; null where neither has it.
  const FbxElement* property(const FbxObject& object, std::string_view name) const;
  double number(const FbxObject& object, std::string_view name, double otherwise) const;
  glm::dvec3 vector(const FbxObject& object, std::string_view name, const glm::dvec3& otherwise) const;

  // What is connected to an object, in the order of the file's connections; to one of its properties where
  // `property` names it. Only objects of this kind; "": of all.
  std::vector<const FbxObject*> sources(std::int64_t id, std::string_view kind,
                                        std::string_view property = {}) const;
  // The other way: what an object is connected to.
  std::vector<const FbxObject*> targets(std::int64_t id, std::string_view kind) const;
  struct Connection {
    std::int64_t source = 0, target = 0;
    std::string_view property;  // empty: to the object itself
  };
  // All that are connected to an object or its properties.
  const std::vector<Connection>& connections_to(std::int64_t id) const;
  // The objects whose properties an object is connected to, with the property.
  std::vector<std::pair<std::int64_t, std::string_view>> properties_of(std::int64_t id) const;

 private:
  void read_objects();
  void read_templates();
  void read_connections();

  FbxTree tree_;
  double ticks_per_second_ = 46186158000.0;
  std::vector<FbxObject> objects_;
  std::unordered_map<std::int64_t, std::size_t> by_id_;
  std::unordered_map<std::string_view, const FbxElement*> templates_;  // kind → Properties70
  std::unordered_map<std::int64_t, std::vector<Connection>> to_, from_;
};

}  // namespace plisse::io
