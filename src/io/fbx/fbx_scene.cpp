// Objects and connections of an FBX file (see fbx_scene.h).
#include "io/fbx/fbx_scene.h"

#include <cmath>
#include <utility>

namespace plisse::io {
namespace {

// "Model::Name" in ASCII files, "Name\0\1Model" in binary ones.
std::string_view plain_name(std::string_view name) {
  if (const std::size_t mark = name.find(std::string_view("\0\1", 2)); mark != std::string_view::npos)
    return name.substr(0, mark);
  if (const std::size_t mark = name.find("::"); mark != std::string_view::npos) return name.substr(mark + 2);
  return name;
}

const FbxElement* find_property(const FbxElement* list, std::string_view name) {
  if (list == nullptr) return nullptr;
  for (const FbxElement& one : list->children)
    if (one.text(0) == name) return &one;
  return nullptr;
}

// P: name, type, label, flags, value …
constexpr std::size_t first_value = 4;

}  // namespace

FbxScene::FbxScene(std::string bytes) : tree_(std::move(bytes)) {
  read_objects();
  read_templates();
  read_connections();
  // KTime was made coarser with version 8; TCDefinition 127 says that it is the old one after all.
  if (tree_.version() < 8000) return;
  ticks_per_second_ = 141120000.0;
  if (const FbxElement* head = tree_.root().child("FBXHeaderExtension"))
    if (const FbxElement* flags = head->child("OtherFlags"))
      if (const FbxElement* definition = flags->child("TCDefinition"))
        if (definition->integer(0) == 127) ticks_per_second_ = 46186158000.0;
}

void FbxScene::read_objects() {
  const FbxElement* list = tree_.root().child("Objects");
  if (list == nullptr) return;
  objects_.reserve(list->children.size());
  for (const FbxElement& element : list->children) {
    if (element.values.size() < 2) continue;
    FbxObject object;
    object.id = element.integer(0);
    object.kind = element.name;
    object.name = plain_name(element.text(1));
    object.type = element.text(2);
    object.element = &element;
    if (by_id_.emplace(object.id, objects_.size()).second) objects_.push_back(object);
  }
}

void FbxScene::read_templates() {
  const FbxElement* definitions = tree_.root().child("Definitions");
  if (definitions == nullptr) return;
  for (const FbxElement& type : definitions->children) {
    if (type.name != "ObjectType") continue;
    if (const FbxElement* one = type.child("PropertyTemplate"))
      if (const FbxElement* properties = one->child("Properties70"))
        templates_.emplace(type.text(0), properties);
  }
}

void FbxScene::read_connections() {
  const FbxElement* list = tree_.root().child("Connections");
  if (list == nullptr) return;
  for (const FbxElement& element : list->children) {
    if (element.name != "C") continue;
    const std::string_view kind = element.text(0);
    if (kind != "OO" && kind != "OP") continue;
    const Connection one{element.integer(1), element.integer(2),
                         kind == "OP" ? element.text(3) : std::string_view()};
    to_[one.target].push_back(one);
    from_[one.source].push_back(one);
  }
}

const FbxObject* FbxScene::object(std::int64_t id) const {
  const auto found = by_id_.find(id);
  return found == by_id_.end() ? nullptr : &objects_[found->second];
}

const FbxElement* FbxScene::property(const FbxObject& object, std::string_view name) const {
  const FbxElement* found = find_property(object.element->child("Properties70"), name);
  if (found != nullptr) return found;
  const auto of_class = templates_.find(object.kind);
  return of_class == templates_.end() ? nullptr : find_property(of_class->second, name);
}

double FbxScene::number(const FbxObject& object, std::string_view name, double otherwise) const {
  const FbxElement* found = property(object, name);
  if (found == nullptr || found->values.size() <= first_value) return otherwise;
  const double number = found->number(first_value);
  return std::isfinite(number) ? number : otherwise;
}

glm::dvec3 FbxScene::vector(const FbxObject& object, std::string_view name,
                            const glm::dvec3& otherwise) const {
  const FbxElement* found = property(object, name);
  if (found == nullptr || found->values.size() < first_value + 3) return otherwise;
  const glm::dvec3 vector{found->number(first_value), found->number(first_value + 1),
                          found->number(first_value + 2)};
  return std::isfinite(vector.x) && std::isfinite(vector.y) && std::isfinite(vector.z) ? vector : otherwise;
}

const std::vector<FbxScene::Connection>& FbxScene::connections_to(std::int64_t id) const {
  static const std::vector<Connection> none;
  const auto found = to_.find(id);
  return found == to_.end() ? none : found->second;
}

std::vector<const FbxObject*> FbxScene::sources(std::int64_t id, std::string_view kind,
                                                std::string_view property) const {
  std::vector<const FbxObject*> result;
  for (const Connection& one : connections_to(id)) {
    if (one.property != property) continue;
    const FbxObject* source = object(one.source);
    if (source != nullptr && (kind.empty() || source->kind == kind)) result.push_back(source);
  }
  return result;
}

std::vector<const FbxObject*> FbxScene::targets(std::int64_t id, std::string_view kind) const {
  std::vector<const FbxObject*> result;
  const auto found = from_.find(id);
  if (found == from_.end()) return result;
  for (const Connection& one : found->second) {
    if (!one.property.empty()) continue;
    const FbxObject* target = object(one.target);
    if (target != nullptr && (kind.empty() || target->kind == kind)) result.push_back(target);
  }
  return result;
}

std::vector<std::pair<std::int64_t, std::string_view>> FbxScene::properties_of(std::int64_t id) const {
  std::vector<std::pair<std::int64_t, std::string_view>> result;
  if (const auto found = from_.find(id); found != from_.end())
    for (const Connection& one : found->second)
      if (!one.property.empty()) result.emplace_back(one.target, one.property);
  return result;
}

}  // namespace plisse::io
