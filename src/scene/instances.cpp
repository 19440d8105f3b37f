// Gathering the instances of a model (see instances.h).
//
// A skinned mesh has no position of its own: bone b maps a vertex x to world(b)·offset_b·x = G_b·x. If the
// nodes are as they were at bind time, all G_b are equal, and A = G maps the mesh into the world. If not, the
// G_b differ by motions; but bones rarely change size, so the stretch U = √(GᵀG) is the same for all of them.
// So A takes its stretch from the bone whose U is nearest to the others' (weighted by the share of the skin
// that it moves), and rotation and position from the bone nearest the root. Armatures scaled by 0.01 or 100,
// and meshes scaled along one axis, are then not compressed at rest.
#include "scene/instances.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "base/log.h"

namespace plisse::scene {
namespace {

// A matrix whose determinant is this small relative to its size counts as singular.
constexpr double singular = 1e-9;

bool invertible(const glm::dmat4& m) {
  const glm::dmat3 linear(m);
  double size = 0;
  for (int axis = 0; axis < 3; ++axis) size = std::max(size, glm::length(linear[axis]));
  return size > 0 && std::isfinite(size) &&
         std::abs(glm::determinant(linear)) > singular * size * size * size;
}

Eigen::Matrix3d eigen(const glm::dmat3& m) {
  return Eigen::Map<const Eigen::Matrix3d>(&m[0][0]);
}
glm::dmat3 glm3(const Eigen::Matrix3d& m) {
  glm::dmat3 result;
  Eigen::Map<Eigen::Matrix3d> columns(&result[0][0]);
  columns = m;
  return result;
}

// U of the polar decomposition M = R·U.
Eigen::Matrix3d stretch_of(const Eigen::Matrix3d& m) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m.transpose() * m).operatorSqrt();
}

// The matrix A of a skinned mesh (see the top of this file); nothing where no bone defines one.
std::optional<glm::dmat4> bind_matrix(const io::Mesh& mesh, const std::vector<glm::dmat4>& world) {
  struct Candidate {
    glm::dmat4 matrix;
    Eigen::Matrix3d stretch;
    double share;
    int node;
  };
  std::vector<double> shares(mesh.bones.size(), 0);
  for (const io::Influences& influences : mesh.influences)
    for (std::size_t i = 0; i < influences.bone.size(); ++i)
      if (influences.weight[i] > 0) shares[influences.bone[i]] += static_cast<double>(influences.weight[i]);
  std::vector<Candidate> candidates;
  for (std::size_t b = 0; b < mesh.bones.size(); ++b) {
    const glm::dmat4 matrix = world[static_cast<std::size_t>(mesh.bones[b].node)] * mesh.bones[b].offset;
    if (shares[b] > 0 && invertible(matrix))
      candidates.push_back({matrix, stretch_of(eigen(glm::dmat3(matrix))), shares[b], mesh.bones[b].node});
  }
  if (candidates.empty()) return std::nullopt;

  const Candidate* typical = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& candidate : candidates) {
    double distance = 0;
    for (const Candidate& other : candidates)
      distance += other.share * (other.stretch - candidate.stretch).norm();
    if (distance < least) {
      least = distance;
      typical = &candidate;
    }
  }
  const Candidate& root =
      *std::min_element(candidates.begin(), candidates.end(),
                        [](const Candidate& a, const Candidate& b) { return a.node < b.node; });
  // Unchanged where the two agree within the rounding of single-precision files: meshes on one skeleton then
  // have exactly the same A, and so the same palette entries.
  if ((root.stretch - typical->stretch).norm() <= 1e-5 * typical->stretch.norm()) return root.matrix;
  const Eigen::Matrix3d turn = eigen(glm::dmat3(root.matrix)) * root.stretch.inverse();
  glm::dmat4 result(glm3(turn * typical->stretch));
  result[3] = root.matrix[3];
  return result;
}

class Gatherer {
 public:
  Gatherer(const io::Model& model, const Rig& rig, const std::vector<double>& times)
      : model_(model),
        rig_(rig),
        times_(times),
        default_(rig.world_at_default()),
        first_(rig.world(times.front())) {
    std::uint32_t offset = 0;
    for (const io::Mesh& mesh : model.meshes) {
      cache_offsets_.push_back(offset);
      offset += static_cast<std::uint32_t>(mesh.positions.size());
    }
  }

  Instances run() {
    const bool cached = !model_.cache.empty();
    if (cached) result_.palette.push_back({});
    for (std::size_t n = 0; n < model_.nodes.size(); ++n) {
      const io::Node& node = model_.nodes[n];
      if (node.meshes.empty()) continue;
      const std::size_t first_target = result_.targets.size();
      if (!cached) add_targets(static_cast<int>(n));
      for (const int id : node.meshes) {
        const io::Mesh& mesh = model_.meshes[static_cast<std::size_t>(id)];
        if (mesh.triangles.empty()) continue;
        placed_ = cached               ? Placed{glm::dmat4{1}, {0}}
                  : mesh.bones.empty() ? place_rigid(static_cast<int>(n))
                                       : place_skin(mesh);
        add_vertices(mesh, static_cast<std::size_t>(id), cached, first_target);
        add_triangles(mesh, node);
      }
    }
    order_as_file();
    spread_deltas();
    return std::move(result_);
  }

 private:
  // The placement of an instance: mesh → bind, and the palette entry of each bone (a single one if rigid).
  struct Placed {
    glm::dmat4 matrix{1};
    std::vector<std::uint32_t> entries;
  };

  // The entry with this node and matrix, which is added if there is none. Matrices are equal within the
  // rounding of single-precision files.
  std::uint32_t entry(int node, const glm::dmat4& right) {
    const auto same = [&](const PaletteEntry& known) {
      if (known.node != node) return false;
      double size = 0, place = 0, difference = 0, shift = 0;
      for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 3; ++r) {
          (c < 3 ? size : place) = std::max(c < 3 ? size : place, std::abs(right[c][r]));
          (c < 3 ? difference : shift) =
              std::max(c < 3 ? difference : shift, std::abs(right[c][r] - known.right[c][r]));
        }
      return difference <= 1e-6 * size && shift <= 1e-6 * place;
    };
    const auto known = std::find_if(result_.palette.begin(), result_.palette.end(), same);
    if (known != result_.palette.end()) return static_cast<std::uint32_t>(known - result_.palette.begin());
    result_.palette.push_back({node, right});
    return static_cast<std::uint32_t>(result_.palette.size()) - 1;
  }

  Placed place_skin(const io::Mesh& mesh) {
    Placed placed;
    if (const auto matrix = bind_matrix(mesh, default_))
      placed.matrix = *matrix;
    else
      log::warn(fmt::format(
          "{}: no bone of mesh '{}' has a matrix that can be inverted; its size at rest is a guess",
          model_.path.string(), mesh.name));
    const glm::dmat4 inverse = glm::inverse(placed.matrix);
    std::vector<bool> used(mesh.bones.size(), false);
    for (const io::Influences& influences : mesh.influences)
      for (std::size_t i = 0; i < influences.bone.size(); ++i)
        if (influences.weight[i] > 0) used[influences.bone[i]] = true;
    placed.entries.assign(mesh.bones.size(), 0);
    for (std::size_t b = 0; b < mesh.bones.size(); ++b)
      if (used[b]) placed.entries[b] = entry(mesh.bones[b].node, mesh.bones[b].offset * inverse);
    return placed;
  }

  // Uses only the motion of the moving ancestor since the first frame, so that vertices with the same
  // ancestor can be welded.
  Placed place_rigid(int node) {
    const int moving = rig_.moving_ancestor(node);
    if (moving < 0) return {first_[static_cast<std::size_t>(node)], {entry(-1, glm::dmat4{1})}};
    const auto place = [&](const std::vector<glm::dmat4>& world) -> std::optional<Placed> {
      if (!invertible(world[static_cast<std::size_t>(node)]) ||
          !invertible(world[static_cast<std::size_t>(moving)]))
        return std::nullopt;
      return Placed{world[static_cast<std::size_t>(node)],
                    {entry(moving, glm::inverse(world[static_cast<std::size_t>(moving)]))}};
    };
    if (auto placed = place(first_)) return *placed;
    // It starts flat or invisible (scale 0): its rest pose is that of its first appearance.
    for (const double time : times_)
      if (auto placed = place(rig_.world(time))) return *placed;
    if (auto placed = place(default_)) return *placed;
    log::warn(fmt::format("{}: node '{}' is flat in every frame; it rests in its own coordinates",
                          model_.path.string(), model_.nodes[static_cast<std::size_t>(node)].name));
    return {glm::dmat4{1}, {entry(node, glm::dmat4{1})}};
  }

  // Meshes under one node share its weights (a body split by material), so they share the targets as well.
  void add_targets(int node) {
    const std::size_t count = rig_.default_morph_weights(node).size();
    if (count == 0) return;
    const auto& meshes = model_.nodes[static_cast<std::size_t>(node)].meshes;
    const bool skinned = std::any_of(meshes.begin(), meshes.end(), [&](int id) {
      return !model_.meshes[static_cast<std::size_t>(id)].bones.empty();
    });
    const std::vector<double> weights =
        skinned ? rig_.default_morph_weights(node) : rig_.morph_weights(node, times_.front());
    for (std::size_t t = 0; t < count; ++t)
      result_.targets.push_back({node, t, std::isfinite(weights[t]) ? weights[t] : 0});
  }

  void add_vertices(const io::Mesh& mesh, std::size_t id, bool cached, std::size_t first_target) {
    WeldInput& vertices = result_.vertices;
    const glm::dmat3 linear(placed_.matrix);
    // Normals are transformed by the inverse transpose, mirrors included: the outside remains outside.
    const glm::dmat3 for_normals = glm::transpose(glm::inverse(linear));
    const auto first = static_cast<std::uint32_t>(vertices.positions.size());
    std::vector<std::uint32_t>& ids = ids_;
    ids.assign(mesh.positions.size(), std::numeric_limits<std::uint32_t>::max());
    // Vertices without a triangle are left out; every pass would process them for nothing.
    for (const std::uint32_t v : mesh.triangles) ids[v] = 0;
    std::uint32_t next = first;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      if (ids[v] != 0) continue;
      ids[v] = next++;
      vertices.positions.emplace_back(placed_.matrix * glm::dvec4(mesh.positions[v], 1));
      glm::dvec3 normal{0};
      if (!mesh.normals.empty()) normal = for_normals * glm::dvec3(mesh.normals[v]);
      const double length = glm::length(normal);
      result_.normals.push_back(length > 0 && std::isfinite(length) ? normal / length : glm::dvec3{0});
      result_.uvs.push_back(mesh.uvs.empty() ? glm::vec2{0} : mesh.uvs[v]);
      result_.normal_uvs.push_back(mesh.normal_uvs.empty() ? result_.uvs.back() : mesh.normal_uvs[v]);
      result_.colours.push_back(mesh.colours.empty() ? glm::vec4{1} : mesh.colours[v]);
      result_.cache_index.push_back(cache_offsets_[id] + static_cast<std::uint32_t>(v));
      if (!mesh.file_vertices.empty()) numbers_.push_back(mesh.file_vertices[v]);
      vertices.influences.push_back(influences_of(mesh, v, cached));
    }
    if (!cached && !mesh.targets.empty()) deltas_.push_back({&mesh, ids, linear, first_target});
  }

  PaletteInfluences influences_of(const io::Mesh& mesh, std::size_t vertex, bool cached) const {
    PaletteInfluences result;
    if (cached || mesh.bones.empty()) {
      result.entry[0] = placed_.entries[0];
      result.weight[0] = 1;
      return result;
    }
    for (std::size_t i = 0; i < result.entry.size(); ++i) {
      result.weight[i] = mesh.influences[vertex].weight[i];
      if (result.weight[i] > 0) result.entry[i] = placed_.entries[mesh.influences[vertex].bone[i]];
    }
    return result;
  }

  void add_triangles(const io::Mesh& mesh, const io::Node& node) {
    Part part;
    part.mesh = mesh.name.empty() ? node.name : mesh.name;
    part.material = mesh.material;
    if (mesh.material >= 0)
      part.material_name = model_.materials[static_cast<std::size_t>(mesh.material)].name;
    part.first_triangle = static_cast<std::uint32_t>(result_.triangles.size() / 3);
    part.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size() / 3);
    part.has_uv = !mesh.uvs.empty();
    part.has_colours = !mesh.colours.empty();
    result_.parts.push_back(std::move(part));
    const bool mirrored = glm::determinant(glm::dmat3(placed_.matrix)) < 0;
    copies_known_.clear();
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t c = 0; c < 3; ++c) corners[c] = ids_[mesh.triangles[t + c]];
      if (mirrored) std::swap(corners[1], corners[2]);
      if (mesh.flat) flatten(corners);
      result_.triangles.insert(result_.triangles.end(), corners.begin(), corners.end());
    }
  }

  // Gives the corners the triangle's normal. A vertex that has that of another triangle is copied; welding
  // joins the copies again, so that waves cross the edge.
  void flatten(std::array<std::uint32_t, 3>& corners) {
    const auto& x = result_.vertices.positions;
    const glm::dvec3 area = glm::cross(x[corners[1]] - x[corners[0]], x[corners[2]] - x[corners[0]]);
    const double length = glm::length(area);
    if (!(length > 0) || !std::isfinite(length)) return;
    const glm::dvec3 normal = area / length;
    for (std::uint32_t& corner : corners) {
      if (result_.normals[corner] == glm::dvec3(0)) result_.normals[corner] = normal;
      if (result_.normals[corner] == normal) continue;
      const auto [entry, fresh] = copies_known_.try_emplace({corner, {normal.x, normal.y, normal.z}},
                                                            static_cast<std::uint32_t>(x.size()));
      if (fresh) copy(corner, normal);
      corner = entry->second;
    }
  }

  // What each vertex has, but for its normal and its number.
  template <typename Work>
  void each_array(const Work& work) {
    work(result_.vertices.positions);
    work(result_.vertices.influences);
    work(result_.uvs);
    work(result_.normal_uvs);
    work(result_.colours);
    work(result_.cache_index);
  }

  void copy(std::uint32_t vertex, const glm::dvec3& normal) {
    const auto again = [&](auto& items) {
      const auto item = items[vertex];
      items.push_back(item);
    };
    each_array(again);
    if (numbers_.size() == result_.normals.size()) again(numbers_);
    result_.normals.push_back(normal);
    copies_.push_back({static_cast<std::uint32_t>(result_.normals.size() - 1), vertex});
  }

  // Vertices in the order of their numbers in the file, where those are known, whatever the order in which
  // its faces and groups use them: point caches and other programs count by it.
  void order_as_file() {
    const auto& number = numbers_;
    if (number.size() != result_.vertices.positions.size() || std::is_sorted(number.begin(), number.end()))
      return;
    std::vector<std::uint32_t> order(number.size()), place(number.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return number[a] < number[b]; });
    const auto arrange = [&](auto& items) {
      auto arranged = items;
      for (std::size_t i = 0; i < order.size(); ++i) arranged[i] = items[order[i]];
      items = std::move(arranged);
    };
    each_array(arrange);
    arrange(result_.normals);
    for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
    for (std::uint32_t& corner : result_.triangles) corner = place[corner];
    for (Deltas& instance : deltas_)
      for (std::uint32_t& id : instance.ids)
        if (id < place.size()) id = place[id];
    for (Copy& one : copies_) one = {place[one.made], place[one.from]};
  }

  // Deltas are stored target after target for all vertices, so they are arranged when the count is known.
  void spread_deltas() {
    const std::size_t count = result_.vertices.positions.size();
    result_.vertices.target_count = result_.targets.size();
    result_.vertices.target_deltas.assign(result_.targets.size() * count, glm::vec3{0});
    for (const Deltas& instance : deltas_)
      for (std::size_t t = 0; t < instance.mesh->targets.size(); ++t)
        for (std::size_t v = 0; v < instance.ids.size(); ++v)
          if (instance.ids[v] != std::numeric_limits<std::uint32_t>::max())
            result_.vertices.target_deltas[(instance.first_target + t) * count + instance.ids[v]] =
                instance.linear * glm::dvec3(instance.mesh->targets[t].position_deltas[v]);
    for (const auto& [made, from] : copies_)
      for (std::size_t t = 0; t < result_.targets.size(); ++t)
        result_.vertices.target_deltas[t * count + made] = result_.vertices.target_deltas[t * count + from];
  }

  struct Deltas {
    const io::Mesh* mesh;
    std::vector<std::uint32_t> ids;
    glm::dmat3 linear;
    std::size_t first_target;
  };

  struct Copy {
    std::uint32_t made, from;
  };

  const io::Model& model_;
  const Rig& rig_;
  const std::vector<double>& times_;
  const std::vector<glm::dmat4> default_, first_;
  std::vector<std::uint32_t> cache_offsets_;
  Instances result_;
  Placed placed_;
  std::vector<std::uint32_t> numbers_;  // in the file, of each gathered vertex where all are known
  std::vector<std::uint32_t> ids_;      // mesh vertex → gathered vertex, of the current instance
  std::vector<Deltas> deltas_;
  std::map<std::pair<std::uint32_t, std::array<double, 3>>, std::uint32_t> copies_known_;  // of this instance
  std::vector<Copy> copies_;
};

}  // namespace

Instances gather_instances(const io::Model& model, const Rig& rig, const std::vector<double>& times) {
  return Gatherer(model, rig, times).run();
}

}  // namespace plisse::scene
