// What every Model must keep, whichever reader made it. Values of animation keys may be non-finite: a pose
// made of them is held back later (contract.md, "Exit codes"); everything else here decides memory and
// indices and must be sound.
#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "io/import.h"

namespace plisse::io {
namespace {

bool finite(double value) {
  return std::isfinite(value);
}
bool finite(const glm::vec2& v) {
  return std::isfinite(v.x) && std::isfinite(v.y);
}
bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool finite(const glm::vec4& v) {
  return finite(glm::vec3(v)) && std::isfinite(v.w);
}
bool finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool finite(const glm::dmat4& m) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(m[column][row])) return false;
  return true;
}

class Check {
 public:
  Check(const Model& model, const Limits& limits) : model_(model), limits_(limits) {}

  void run() const {
    limits();
    std::size_t triangles = 0;
    for (std::size_t m = 0; m < model_.materials.size(); ++m) material(m);
    for (const Texture& item : model_.textures) texture(item);
    for (const Mesh& item : model_.meshes) {
      mesh(item);
      triangles += item.triangles.size() / 3;
    }
    if (triangles == 0) fail("holds no triangles: there is nothing to wrinkle in it");
    bool shown = false;
    for (std::size_t n = 0; n < model_.nodes.size(); ++n) shown |= node(n);
    if (!shown) fail("no node places any of its meshes: there is nothing to show");
    for (const Clip& item : model_.clips) clip(item);
    for (const Camera& item : model_.cameras) {
      if (!is_node(item.node))
        fail(fmt::format("camera '{}' stands at node {}, of {}", item.name, item.node, model_.nodes.size()));
      if (!(item.vertical_field_of_view > 0 && item.vertical_field_of_view < 3.1416) ||
          !(item.half_height >= 0) || !finite(item.half_height))
        fail(fmt::format("camera '{}' has no usable opening: {} rad, half height {}", item.name,
                         item.vertical_field_of_view, item.half_height));
    }
    cache();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ExitCode::bad_input, fmt::format("{}: {}", model_.path.string(), what));
  }

  bool is_node(int id) const { return id >= 0 && static_cast<std::size_t>(id) < model_.nodes.size(); }

  template <typename Items>
  void all_finite(const Items& items, const std::string& what) const {
    for (std::size_t i = 0; i < items.size(); ++i)
      if (!finite(items[i])) fail(fmt::format("{} {} is not finite", what, i));
  }

  template <typename Items>
  void count(const Items& items, std::size_t expected, const std::string& what) const {
    if (!items.empty() && items.size() != expected)
      fail(fmt::format("{}: {} of them for {} vertices", what, items.size(), expected));
  }

  void material(std::size_t id) const {
    const Material& item = model_.materials[id];
    for (const int texture : {item.base_colour_texture, item.normal_texture})
      if (texture >= static_cast<int>(model_.textures.size()))
        fail(
            fmt::format("material '{}' names texture {}, of {}", item.name, texture, model_.textures.size()));
    if (!finite(item.base_colour))
      fail(fmt::format("the base colour of material '{}' is not finite", item.name));
    if (!std::isfinite(item.normal_scale) || !std::isfinite(item.alpha_cutoff))
      fail(fmt::format("the normal scale or alpha cutoff of material '{}' is not finite", item.name));
  }

  void texture(const Texture& item) const {
    const Image& image = item.image;
    if (image.width <= 0 || image.height <= 0 ||
        image.rgba.size() !=
            std::size_t{4} * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
      fail(fmt::format("texture '{}' of {}×{} has {} bytes", item.name, image.width, image.height,
                       image.rgba.size()));
  }

  void mesh(const Mesh& item) const {
    const std::string name = fmt::format("mesh '{}': ", item.name);
    const std::size_t vertices = item.positions.size();
    if (item.triangles.size() % 3 != 0)
      fail(fmt::format("{}{} triangle indices are not a multiple of three", name, item.triangles.size()));
    for (std::size_t i = 0; i < item.triangles.size(); ++i)
      if (item.triangles[i] >= vertices)
        fail(fmt::format("{}triangle {} names vertex {}, of {}", name, i / 3, item.triangles[i], vertices));
    all_finite(item.positions, name + "position");
    // Damaged files turn into numbers of any size. The passes square lengths in single precision, which ends
    // at 1.8e19.
    constexpr double far = 1e18;
    for (std::size_t v = 0; v < vertices; ++v)
      if (glm::any(glm::greaterThan(glm::abs(item.positions[v]), glm::dvec3(far))))
        fail(fmt::format("{}vertex {} lies over {:g} units from the origin", name, v, far));
    all_finite(item.normals, name + "normal");
    all_finite(item.uvs, name + "uv");
    count(item.normals, vertices, name + "normals");
    count(item.uvs, vertices, name + "uvs");
    all_finite(item.normal_uvs, name + "uv of the normal map");
    all_finite(item.colours, name + "colour");
    count(item.normal_uvs, vertices, name + "uvs of the normal map");
    count(item.colours, vertices, name + "colours");
    if (item.material >= static_cast<int>(model_.materials.size()))
      fail(fmt::format("{}material {}, of {}", name, item.material, model_.materials.size()));
    for (const MorphTarget& target : item.targets) {
      if (target.position_deltas.size() != vertices)
        fail(fmt::format("{}morph target '{}' has {} deltas for {} vertices", name, target.name,
                         target.position_deltas.size(), vertices));
      all_finite(target.position_deltas, name + "morph target '" + target.name + "': delta");
    }
    count(item.file_vertices, vertices, name + "numbers in the file");
    for (const std::uint32_t number : item.file_vertices)
      if (number >= model_.file_vertex_count)
        fail(fmt::format("{}a vertex has number {} in a file of {}", name, number, model_.file_vertex_count));
    bones(item, name);
  }

  void bones(const Mesh& item, const std::string& name) const {
    if (item.influences.size() != (item.bones.empty() ? 0 : item.positions.size()))
      fail(fmt::format("{}{} vertices, {} with bone weights", name, item.positions.size(),
                       item.influences.size()));
    for (std::size_t b = 0; b < item.bones.size(); ++b) {
      if (!is_node(item.bones[b].node))
        fail(fmt::format("{}bone {} moves with node {}, of {}", name, b, item.bones[b].node,
                         model_.nodes.size()));
      if (!finite(item.bones[b].offset))
        fail(fmt::format("{}the bind matrix of bone {} is not finite", name, b));
    }
    for (std::size_t v = 0; v < item.influences.size(); ++v) {
      double sum = 0;
      for (std::size_t i = 0; i < max_influences; ++i) {
        const float weight = item.influences[v].weight[i];
        if (!(weight >= 0) || !std::isfinite(weight))
          fail(fmt::format("{}vertex {} has a bone weight of {}", name, v, weight));
        if (weight > 0 && item.influences[v].bone[i] >= item.bones.size())
          fail(fmt::format("{}vertex {} names bone {}, of {}", name, v, item.influences[v].bone[i],
                           item.bones.size()));
        sum += static_cast<double>(weight);
      }
      // Eight rounded weights: 8 · 2^-24, and a decade of room.
      if (std::abs(sum - 1) > 5e-6)
        fail(fmt::format("{}the bone weights of vertex {} sum to {}, not 1", name, v, sum));
    }
  }

  // Whether the node places a mesh.
  bool node(std::size_t id) const {
    const Node& item = model_.nodes[id];
    if (item.parent < -1 || item.parent >= static_cast<int>(id))
      fail(fmt::format("node {} '{}' has the parent {}: parents must come before their children", id,
                       item.name, item.parent));
    if (!finite(item.local)) fail(fmt::format("the matrix of node '{}' is not finite", item.name));
    all_finite(item.morph_weights, fmt::format("node '{}': morph weight", item.name));
    std::size_t targets = 0;
    for (const int mesh_id : item.meshes) {
      if (mesh_id < 0 || static_cast<std::size_t>(mesh_id) >= model_.meshes.size())
        fail(fmt::format("node '{}' shows mesh {}, of {}", item.name, mesh_id, model_.meshes.size()));
      targets = std::max(targets, model_.meshes[static_cast<std::size_t>(mesh_id)].targets.size());
    }
    if (item.morph_weights.size() != targets)
      fail(fmt::format("node '{}' has {} morph weights for {} targets", item.name, item.morph_weights.size(),
                       targets));
    return !item.meshes.empty();
  }

  template <typename Value>
  void keys(const Keys<Value>& track, const std::string& name) const {
    if (track.values.size() != track.times.size())
      fail(fmt::format("{}{} key times for {} values", name, track.times.size(), track.values.size()));
    if (track.interpolation == Interpolation::cubic_spline &&
        (track.in_tangents.size() != track.times.size() || track.out_tangents.size() != track.times.size()))
      fail(fmt::format("{}{} keys with {} and {} tangents", name, track.times.size(),
                       track.in_tangents.size(), track.out_tangents.size()));
    all_finite(track.times, name + "key time");
    for (std::size_t k = 1; k < track.times.size(); ++k)
      if (!(track.times[k] > track.times[k - 1]))
        fail(fmt::format("{}key {} does not come after the one before", name, k));
  }

  void clip(const Clip& item) const {
    if (!(item.duration >= 0) || !std::isfinite(item.duration))
      fail(fmt::format("clip '{}' lasts {} s", item.name, item.duration));
    for (const Channel& channel : item.channels) {
      const std::string name = fmt::format("clip '{}', node {}: ", item.name, channel.node);
      if (!is_node(channel.node)) fail(name + "no such node");
      keys(channel.translation, name + "translation: ");
      keys(channel.rotation, name + "rotation: ");
      keys(channel.scale, name + "scale: ");
      keys(channel.morph_weights, name + "morph weights: ");
      const std::size_t targets = model_.nodes[static_cast<std::size_t>(channel.node)].morph_weights.size();
      for (const auto* list : {&channel.morph_weights.values, &channel.morph_weights.in_tangents,
                               &channel.morph_weights.out_tangents})
        for (const std::vector<double>& weights : *list)
          if (weights.size() != targets)
            fail(fmt::format("{}{} morph weights for {} targets", name, weights.size(), targets));
    }
  }

  // The first frame; the others are read when they are asked for, by what checks that all are alike.
  void cache() const {
    if (model_.cache.empty()) return;
    std::size_t vertices = 0;
    for (const Mesh& item : model_.meshes) vertices += item.positions.size();
    if (!(model_.cache.frames_per_second() > 0) || !finite(model_.cache.frames_per_second()))
      fail(fmt::format("a cache of {} frames a second", model_.cache.frames_per_second()));
    if (model_.cache.frame(0)->size() != vertices)
      fail(fmt::format("frame 1 of the cache has {} positions for {} vertices", model_.cache.frame(0)->size(),
                       vertices));
  }

  // First of all: what follows costs time by these counts.
  void limits() const {
    std::uint64_t vertices = 0, triangles = 0, bones = 0, keys = 0, pixels = 0;
    for (const Mesh& item : model_.meshes) {
      vertices += item.positions.size();
      triangles += item.triangles.size() / 3;
      bones += item.bones.size();
    }
    for (const Clip& item : model_.clips)
      for (const Channel& channel : item.channels)
        keys += channel.translation.times.size() + channel.rotation.times.size() +
                channel.scale.times.size() + channel.morph_weights.times.size();
    for (const Texture& item : model_.textures) pixels += item.image.rgba.size() / 4;
    const auto check = [&](int Limits::*limit, const char* key, std::uint64_t found, const char* what) {
      const std::string wrong = over_limit(limits_, limit, key, found, what);
      if (!wrong.empty()) fail(wrong);
    };
    check(&Limits::vertices, "vertices", vertices, "vertices");
    check(&Limits::triangles, "triangles", triangles, "triangles");
    check(&Limits::bones, "bones", bones, "bones");
    check(&Limits::keys, "keys", keys, "keys of its clips");
    check(&Limits::texture_pixels, "texture_pixels", pixels, "pixels of textures");
  }

  const Model& model_;
  const Limits& limits_;
};

}  // namespace

void validate(const Model& model, const Limits& limits) {
  Check(model, limits).run();
}

}  // namespace plisse::io
