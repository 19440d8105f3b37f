// glTF meshes: primitives as triangles, skins, morph targets (glTF 2.0, 3.7).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/log.h"
#include "io/gltf/import_gltf_parts.h"
#include "io/influences.h"

namespace plisse::io {
namespace {

enum class Mode { triangles = 4, strip = 5, fan = 6 };

// Lists of three from what the mode makes of the indices. What is left over at the end forms no triangle.
std::vector<std::uint32_t> triangles_of(const std::vector<std::uint32_t>& indices, Mode mode) {
  std::vector<std::uint32_t> result;
  const std::size_t count = indices.size();
  if (count < 3) return result;
  if (mode == Mode::triangles) {
    result.assign(indices.begin(), indices.begin() + static_cast<std::ptrdiff_t>(count / 3 * 3));
    return result;
  }
  result.reserve(3 * (count - 2));
  for (std::size_t i = 0; i + 2 < count; ++i) {
    // glTF 2.0, 3.7.2.1: a strip turns every other triangle round; a fan's centre comes last.
    if (mode == Mode::strip)
      result.insert(result.end(), {indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
    else
      result.insert(result.end(), {indices[i + 1], indices[i + 2], indices[0]});
  }
  return result;
}

GltfPrimitive read_primitive(GltfFile& file, const GltfValue& source) {
  if (const GltfValue draco = source["extensions"]["KHR_draco_mesh_compression"])
    return read_gltf_draco(file, source, draco);
  GltfPrimitive result;
  result.vertices = static_cast<std::size_t>(
      file.list("accessors")
          .at(source["attributes"]["POSITION"].index(file.list("accessors")))["count"]
          .count());
  if (const GltfValue indices = source["indices"]) {
    const GltfArray array = read_gltf_accessor(file, indices, {"SCALAR"});
    result.indices.reserve(array.count);
    for (const double value : array.values) {
      if (!(value >= 0 && value < static_cast<double>(result.vertices)))
        indices.fail(fmt::format("names vertex {}, of {}", value, result.vertices));
      result.indices.push_back(static_cast<std::uint32_t>(value));
    }
  }
  result.indexed = static_cast<bool>(source["indices"]);
  return result;
}

class PrimitiveReader {
 public:
  PrimitiveReader(GltfFile& file, const GltfValue& mesh, const GltfValue& primitive)
      : file_(file), mesh_(mesh), source_(primitive), data_(read_primitive(file, primitive)) {}

  Mesh read(Mode mode, const std::string& name, const std::vector<GltfLook>& looks) {
    Mesh result;
    result.name = name;
    result.material = source_["material"].index_or_none(file_.list("materials"));
    const GltfArray positions = attribute("POSITION", {"VEC3"});
    result.positions.reserve(positions.count);
    for (std::size_t v = 0; v < positions.count; ++v)
      result.positions.emplace_back(positions[v][0], positions[v][1], positions[v][2]);
    if (!data_.indexed) {
      data_.indices.resize(data_.vertices);
      for (std::size_t v = 0; v < data_.vertices; ++v) data_.indices[v] = static_cast<std::uint32_t>(v);
    }
    result.triangles = triangles_of(data_.indices, mode);
    if (mode == Mode::triangles && data_.indices.size() % 3 != 0)
      log::warn_once(
          "odd indices " + file_.path().string() + name,
          fmt::format("{}: mesh '{}' has {} corners, not a multiple of three; the last are left out",
                      file_.path().string(), name, data_.indices.size()));
    read_normals(result);
    result.flat = result.normals.empty();  // glTF 2.0, 3.7.2.1
    read_colours(result);
    const GltfLook look =
        result.material >= 0 ? looks[static_cast<std::size_t>(result.material)] : GltfLook{};
    result.uvs = read_uvs(look.colour);
    if (!(look.normal == look.colour)) result.normal_uvs = read_uvs(look.normal);
    if (result.uvs.empty()) result.uvs.swap(result.normal_uvs);
    read_targets(result);
    return result;
  }

  // Moved by the joints of a skin.
  void read_skin(const GltfValue& skin, int holder, const std::vector<int>& nodes, Mesh& mesh) {
    if (!source_["attributes"]["JOINTS_0"]) return;
    const GltfValue joints = skin["joints"];
    const std::size_t bones = joints.size();
    GltfArray binds;
    if (const GltfValue matrices = skin["inverseBindMatrices"]) {
      binds = read_gltf_accessor(file_, matrices, {"MAT4"});
      if (binds.count < bones)
        matrices.fail(fmt::format("has {} matrices for {} joints", binds.count, bones));
    }
    for (std::size_t b = 0; b < bones; ++b) {
      Bone& bone = mesh.bones.emplace_back();
      bone.node = nodes[joints.at(b).index(file_.list("nodes"))];
      if (binds.count > 0)
        for (int c = 0; c < 4; ++c)
          for (int r = 0; r < 4; ++r) bone.offset[c][r] = binds[b][4 * c + r];
    }

    std::vector<std::vector<BoneWeight>> weights(mesh.positions.size());
    for (std::size_t set = 0; source_["attributes"][fmt::format("JOINTS_{}", set)]; ++set)
      add_weights(set, bones, weights);
    std::size_t most = 0, cut = 0, unbound = 0;
    for (const auto& of_vertex : weights) {
      most = std::max(most, of_vertex.size());
      cut += of_vertex.size() > max_influences ? 1 : 0;
      unbound += of_vertex.empty() ? 1 : 0;
    }
    mesh.file_max_influences = static_cast<int>(most);
    if (cut > 0)
      log::warn_once(
          "influences " + file_.path().string() + mesh.name,
          fmt::format("{}: mesh '{}' has up to {} bones on a vertex; the strongest {} are kept on {} "
                      "vertices",
                      file_.path().string(), mesh.name, most, max_influences, cut));
    if (unbound > 0) {
      mesh.bones.push_back({holder, glm::dmat4{1}});
      log::warn_once("unbound " + file_.path().string() + mesh.name,
                     fmt::format("{}: {} vertices of mesh '{}' have no bone; they move with its node",
                                 file_.path().string(), unbound, mesh.name));
    }
    mesh.influences.reserve(weights.size());
    for (auto& of_vertex : weights)
      mesh.influences.push_back(strongest(of_vertex, static_cast<std::uint32_t>(bones)));
  }

 private:
  // One entry per vertex; empty where the primitive has none of that name.
  GltfArray attribute(const std::string& name, std::initializer_list<std::string_view> types) {
    const GltfValue at = source_["attributes"][name];
    if (!at) return {};
    GltfArray array;
    if (const auto decoded = data_.attributes.find(name); decoded != data_.attributes.end())
      array = decoded->second;
    else
      array = read_gltf_accessor(file_, at, types);
    if (array.count != data_.vertices)
      at.fail(fmt::format("has {} entries for {} vertices", array.count, data_.vertices));
    const std::string_view least = *types.begin();
    if (array.width < static_cast<std::size_t>(least.back() - '0'))
      at.fail(fmt::format("has {} numbers a vertex, must be {}", array.width, least));
    return array;
  }

  void read_normals(Mesh& mesh) {
    const GltfArray normals = attribute("NORMAL", {"VEC3"});
    mesh.normals.reserve(normals.count);
    for (std::size_t v = 0; v < normals.count; ++v) {
      const glm::dvec3 normal(normals[v][0], normals[v][1], normals[v][2]);
      const double length = glm::length(normal);
      mesh.normals.emplace_back(length > 0 && std::isfinite(length) ? normal / length : glm::dvec3{0});
    }
  }

  void read_colours(Mesh& mesh) {
    const GltfArray colours = attribute("COLOR_0", {"VEC3", "VEC4"});
    mesh.colours.reserve(colours.count);
    bool tinted = false;
    for (std::size_t v = 0; v < colours.count; ++v) {
      const double* c = colours[v];
      mesh.colours.emplace_back(c[0], c[1], c[2], colours.width == 4 ? c[3] : 1);
      tinted |= mesh.colours.back() != glm::vec4(1);
    }
    if (!tinted) mesh.colours.clear();
  }

  std::vector<glm::vec2> read_uvs(const GltfUvs& look) {
    const GltfArray uvs = attribute(fmt::format("TEXCOORD_{}", look.set), {"VEC2"});
    std::vector<glm::vec2> result;
    result.reserve(uvs.count);
    for (std::size_t v = 0; v < uvs.count; ++v) {
      const glm::dvec3 uv = look.transform * glm::dvec3(uvs[v][0], uvs[v][1], 1);
      result.emplace_back(uv.x, 1 - uv.y);  // glTF's v points down the picture, ours up
    }
    return result;
  }

  void add_weights(std::size_t set, std::size_t bones, std::vector<std::vector<BoneWeight>>& weights) {
    const std::string joint_name = fmt::format("JOINTS_{}", set),
                      weight_name = fmt::format("WEIGHTS_{}", set);
    const GltfArray joints = attribute(joint_name, {"VEC4"}), shares = attribute(weight_name, {"VEC4"});
    if (shares.count == 0 && joints.count > 0)
      source_["attributes"].fail(joint_name + " without " + weight_name);
    for (std::size_t v = 0; v < joints.count; ++v)
      for (std::size_t i = 0; i < 4; ++i) {
        const double joint = joints[v][i], weight = shares[v][i];
        if (!(weight > 0) || !std::isfinite(weight)) continue;
        if (!(joint >= 0 && joint < static_cast<double>(bones)))
          source_["attributes"][joint_name].fail(
              fmt::format("vertex {} names joint {}, of {}", v, joint, bones));
        const auto bone = static_cast<std::uint32_t>(joint);
        const auto same = std::find_if(weights[v].begin(), weights[v].end(),
                                       [bone](const BoneWeight& known) { return known.bone == bone; });
        if (same != weights[v].end())
          same->weight += weight;
        else
          weights[v].push_back({bone, weight});
      }
  }

  // Posed normals follow from posed positions (docs/passes.md, "Skin"), so a target's own normals are not
  // needed.
  void read_targets(Mesh& mesh) {
    const GltfValue targets = source_["targets"], names = mesh_["extras"]["targetNames"];
    for (std::size_t t = 0; t < targets.size(); ++t) {
      MorphTarget& target = mesh.targets.emplace_back();
      if (t < names.size()) target.name = names.at(t).text("");
      target.position_deltas.assign(mesh.positions.size(), glm::vec3{0});
      const GltfValue at = targets.at(t)["POSITION"];
      if (!at) continue;
      const GltfArray deltas = read_gltf_accessor(file_, at, {"VEC3"});
      if (deltas.count != mesh.positions.size())
        at.fail(fmt::format("has {} entries for {} vertices", deltas.count, mesh.positions.size()));
      for (std::size_t v = 0; v < deltas.count; ++v)
        target.position_deltas[v] = glm::vec3(deltas[v][0], deltas[v][1], deltas[v][2]);
    }
  }

  GltfFile& file_;
  GltfValue mesh_, source_;
  GltfPrimitive data_;
};

}  // namespace

std::vector<Mesh> read_gltf_mesh(GltfFile& file, std::size_t id, int skin, int holder,
                                 const std::vector<int>& nodes, const std::vector<GltfLook>& looks) {
  const GltfValue mesh = file.list("meshes").at(id);
  const std::string name = mesh["name"].text("");
  const GltfValue primitives = mesh["primitives"];
  std::vector<Mesh> result;
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    const GltfValue source = primitives.at(p);
    const std::uint64_t mode = source["mode"].count(4);
    if (mode > 6) source["mode"].fail(fmt::format("is {}, must be 0 to 6", mode));
    if (mode < 4) {
      log::warn_once("points " + file.path().string(),
                     fmt::format("{}: mesh '{}' has points or lines; only triangles are drawn",
                                 file.path().string(), name));
      continue;
    }
    if (!source["attributes"]["POSITION"]) {
      log::warn_once("no positions " + file.path().string(),
                     fmt::format("{}: mesh '{}' has a part without positions; it is left out",
                                 file.path().string(), name));
      continue;
    }
    PrimitiveReader reader(file, mesh, source);
    Mesh made = reader.read(static_cast<Mode>(mode), name.empty() ? fmt::format("mesh {}", id) : name, looks);
    if (made.triangles.empty()) continue;
    if (skin >= 0)
      reader.read_skin(file.list("skins").at(static_cast<std::size_t>(skin)), holder, nodes, made);
    result.push_back(std::move(made));
  }
  return result;
}

}  // namespace plisse::io
