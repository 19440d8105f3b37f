// glTF nodes: the scene's tree, and the meshes, skins and cameras that hang in it (glTF 2.0, 3.5;
// EXT_mesh_gpu_instancing).
#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>

#include "base/log.h"
#include "io/gltf/import_gltf_parts.h"

namespace plisse::io {
namespace {

glm::dmat4 placed(const double* t, const double* q, const double* s, const GltfValue& rotation_at) {
  const glm::dquat rotation(q[3], q[0], q[1], q[2]);
  if (!(glm::length(rotation) > 0)) rotation_at.fail("is zero");
  return glm::scale(
      glm::translate(glm::dmat4{1}, glm::dvec3(t[0], t[1], t[2])) * glm::mat4_cast(glm::normalize(rotation)),
      glm::dvec3(s[0], s[1], s[2]));
}

glm::dmat4 local_of(const GltfValue& node) {
  if (node["matrix"]) {
    const std::vector<double> m = node["matrix"].numbers(16, {});
    glm::dmat4 result;
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r) result[c][r] = m[static_cast<std::size_t>(4 * c + r)];
    return result;
  }
  const std::vector<double> t = node["translation"].numbers(3, {0, 0, 0});
  const std::vector<double> q = node["rotation"].numbers(4, {0, 0, 0, 1});
  const std::vector<double> s = node["scale"].numbers(3, {1, 1, 1});
  return placed(t.data(), q.data(), s.data(), node["rotation"]);
}

class NodeReader {
 public:
  NodeReader(GltfFile& file, const std::vector<GltfLook>& looks, Model& model)
      : file_(file),
        sources_(file.list("nodes")),
        looks_(looks),
        model_(model),
        ids_(sources_.size(), -1),
        parents_(sources_.size(), -1),
        shown_(sources_.size(), false) {}

  std::vector<int> run(int world) {
    find_parents();
    for (std::size_t n = 0; n < sources_.size(); ++n)
      if (parents_[n] < 0) add_tree(n, world);
    for (std::size_t n = 0; n < sources_.size(); ++n)
      if (ids_[n] < 0) sources_.at(n).fail("is its own ancestor: the nodes form a ring");
    find_shown();
    for (std::size_t n = 0; n < sources_.size(); ++n)
      if (shown_[n]) hang_meshes(n);
    add_cameras();
    return ids_;
  }

 private:
  void find_parents() {
    for (std::size_t n = 0; n < sources_.size(); ++n) {
      const GltfValue children = sources_.at(n)["children"];
      for (std::size_t c = 0; c < children.size(); ++c) {
        const std::size_t child = children.at(c).index(sources_);
        if (parents_[child] >= 0)
          children.at(c).fail(fmt::format("node {} is a child of node {} already", child, parents_[child]));
        parents_[child] = static_cast<int>(n);
      }
    }
  }

  // Parents before children, without recursion: files may nest as deep as they like.
  void add_tree(std::size_t root, int world) {
    std::vector<std::size_t> open{root};
    while (!open.empty()) {
      const std::size_t n = open.back();
      open.pop_back();
      const GltfValue source = sources_.at(n);
      ids_[n] = static_cast<int>(model_.nodes.size());
      Node& node = model_.nodes.emplace_back();
      node.name = source["name"].text(fmt::format("node {}", n));
      node.parent = parents_[n] < 0 ? world : ids_[static_cast<std::size_t>(parents_[n])];
      node.local = local_of(source);
      const GltfValue children = source["children"];
      for (std::size_t c = children.size(); c-- > 0;) open.push_back(children.at(c).index(sources_));
    }
  }

  // The nodes of the scene that the file starts with; all of them where it has no scenes.
  void find_shown() {
    const GltfValue scenes = file_.list("scenes");
    if (scenes.size() == 0) {
      shown_.assign(shown_.size(), true);
      return;
    }
    const GltfValue chosen = file_.root()["scene"];
    const GltfValue roots = scenes.at(chosen ? chosen.index(scenes) : 0)["nodes"];
    std::vector<std::size_t> open;
    for (std::size_t r = 0; r < roots.size(); ++r) open.push_back(roots.at(r).index(sources_));
    while (!open.empty()) {
      const std::size_t n = open.back();
      open.pop_back();
      if (shown_[n]) continue;
      shown_[n] = true;
      const GltfValue children = sources_.at(n)["children"];
      for (std::size_t c = 0; c < children.size(); ++c) open.push_back(children.at(c).index(sources_));
    }
  }

  void hang_meshes(std::size_t n) {
    const GltfValue source = sources_.at(n);
    if (!source["mesh"]) return;
    const std::size_t mesh = source["mesh"].index(file_.list("meshes"));
    const int skin = source["skin"].index_or_none(file_.list("skins"));
    // One mesh may be bound to several skeletons: then it is a mesh for each.
    const auto [known, fresh] = meshes_.try_emplace({mesh, skin});
    if (fresh)
      for (Mesh& made : read_gltf_mesh(file_, mesh, skin, ids_[n], ids_, looks_)) {
        known->second.push_back(static_cast<int>(model_.meshes.size()));
        model_.meshes.push_back(std::move(made));
      }
    Node& node = model_.nodes[static_cast<std::size_t>(ids_[n])];
    node.meshes = known->second;
    std::size_t targets = 0;
    for (const int id : node.meshes)
      targets = std::max(targets, model_.meshes[static_cast<std::size_t>(id)].targets.size());
    const GltfValue weights =
        source["weights"] ? source["weights"] : file_.list("meshes").at(mesh)["weights"];
    if (weights) node.morph_weights = weights.numbers(weights.size(), {});
    node.morph_weights.resize(targets, 0);
    const GltfValue instancing = source["extensions"]["EXT_mesh_gpu_instancing"];
    if (instancing && skin < 0)  // a skin's place is its bones', so there is nothing to repeat
      add_instances(ids_[n], instancing["attributes"]);
  }

  // The node's meshes stand at every instance instead of at the node: a child for each.
  void add_instances(int parent, const GltfValue& attributes) {
    std::size_t count = 0;
    const auto read = [&](const char* name, std::string_view type) {
      GltfArray array;
      if (const GltfValue at = attributes[name]) {
        array = read_gltf_accessor(file_, at, {type});
        if (count > 0 && array.count != count)
          at.fail(fmt::format("has {} elements; the other attributes have {}", array.count, count));
        count = array.count;
      }
      return array;
    };
    const GltfArray t = read("TRANSLATION", "VEC3"), q = read("ROTATION", "VEC4"), s = read("SCALE", "VEC3");
    constexpr double origin[3] = {0, 0, 0}, unturned[4] = {0, 0, 0, 1}, unscaled[3] = {1, 1, 1};
    file_.spend(count * sizeof(Node), attributes);
    const Node holder = model_.nodes[static_cast<std::size_t>(parent)];
    if (!holder.morph_weights.empty())
      log::warn_once("instances " + holder.name,
                     fmt::format("{}: the instances of node '{}' keep the morph weights that it starts with",
                                 file_.path().string(), holder.name));
    for (std::size_t i = 0; i < count; ++i) {
      Node& instance = model_.nodes.emplace_back(holder);
      instance.name = fmt::format("{} ({})", holder.name, i);
      instance.parent = parent;
      instance.local = placed(t.count > 0 ? t[i] : origin, q.count > 0 ? q[i] : unturned,
                              s.count > 0 ? s[i] : unscaled, attributes["ROTATION"]);
    }
    model_.nodes[static_cast<std::size_t>(parent)].meshes.clear();
  }

  // In the order of the file's cameras; one that several nodes hold is there for each.
  void add_cameras() {
    const GltfValue cameras = file_.list("cameras");
    for (std::size_t c = 0; c < cameras.size(); ++c)
      for (std::size_t n = 0; n < sources_.size(); ++n) {
        if (!shown_[n] || !sources_.at(n)["camera"] || sources_.at(n)["camera"].index(cameras) != c) continue;
        const GltfValue source = cameras.at(c);
        Camera& camera = model_.cameras.emplace_back();
        camera.node = ids_[n];
        camera.name = source["name"].text(sources_.at(n)["name"].text(fmt::format("camera {}", c)));
        if (const GltfValue parallel = source["orthographic"]) {
          camera.half_height = parallel["ymag"].number();
          if (!(camera.half_height > 0)) parallel["ymag"].fail("must be above 0");
          continue;
        }
        const GltfValue angle = source["perspective"]["yfov"];
        camera.vertical_field_of_view = angle.number();
        if (!(camera.vertical_field_of_view > 0 && camera.vertical_field_of_view < 3.1416))
          angle.fail(fmt::format("is {}, must be between 0 and π", camera.vertical_field_of_view));
      }
  }

  GltfFile& file_;
  const GltfValue sources_;
  const std::vector<GltfLook>& looks_;
  Model& model_;
  std::vector<int> ids_, parents_;
  std::vector<bool> shown_;
  std::map<std::pair<std::size_t, int>, std::vector<int>> meshes_;
};

}  // namespace

std::vector<int> read_gltf_nodes(GltfFile& file, const glm::dmat4& world, const std::vector<GltfLook>& looks,
                                 Model& model) {
  int root = -1;
  if (world != glm::dmat4{1}) {
    root = 0;
    model.nodes.emplace_back().name = "(world)";
    model.nodes.back().local = world;
  }
  return NodeReader(file, looks, model).run(root);
}

}  // namespace plisse::io
