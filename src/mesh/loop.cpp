#include "mesh/loop.h"

#include <fmt/format.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "base/error.h"

namespace plisse {
namespace {

using OpenSubdiv::Far::Index;
using OpenSubdiv::Far::TopologyDescriptor;
using OpenSubdiv::Far::TopologyRefiner;
using Faces = std::vector<std::array<std::uint32_t, 3>>;

Error bad(const std::string& what) {
  return {ExitCode::bad_input, "the mesh cannot be subdivided: " + what};
}

// Errors that OpenSubdiv does not report: where a surface is not manifold it duplicates or sharpens vertices.
void check_manifold(const Faces& faces, std::uint32_t vertex_count) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> sides;    // (from, to) → face
  std::vector<std::map<std::uint32_t, std::uint32_t>> next(vertex_count);  // round a vertex, outer edges
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto& t = faces[f];
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = t[c], b = t[(c + 1) % 3];
      if (std::max(a, b) >= vertex_count)
        throw bad(fmt::format("face {} names vertex {}, and there are {}", f, std::max(a, b), vertex_count));
      if (a == b) throw bad(fmt::format("face {} names vertex {} twice", f, a));
      const auto [at, fresh] = sides.try_emplace({a, b}, f);
      if (!fresh)
        throw bad(fmt::format(
            "faces {} and {} run along edge {}-{} the same way: an edge may have two faces, one each way",
            at->second, f, a, b));
      next[a][b] = t[(c + 2) % 3];
    }
  }
  for (std::uint32_t v = 0; v < vertex_count; ++v) {
    if (next[v].empty()) continue;
    // Begins at the edge without a predecessor, or at any.
    std::set<std::uint32_t> led_to;
    for (const auto& [from, to] : next[v]) led_to.insert(to);
    std::uint32_t start = next[v].begin()->first;
    for (const auto& [from, to] : next[v])
      if (!led_to.contains(from)) start = from;
    std::size_t steps = 0;
    for (auto at = next[v].find(start); at != next[v].end(); at = next[v].find(at->second)) {
      ++steps;
      if (at->second == start) break;
    }
    if (steps < next[v].size())
      throw bad(fmt::format("the faces at vertex {} hang together only there, not round it", v));
  }
}

std::unique_ptr<TopologyRefiner> refiner_of(const Faces& faces, std::uint32_t vertex_count, int levels,
                                            const std::vector<std::uint32_t>& sharp) {
  const std::vector<int> sizes(faces.size(), 3);
  std::vector<Index> corners, sharp_vertices(sharp.begin(), sharp.end());
  for (const auto& face : faces) corners.insert(corners.end(), face.begin(), face.end());
  const std::vector<float> sharpness(sharp.size(), OpenSubdiv::Sdc::Crease::SHARPNESS_INFINITE);
  TopologyDescriptor descriptor;
  descriptor.numVertices = static_cast<int>(vertex_count);
  descriptor.numFaces = static_cast<int>(faces.size());
  descriptor.numVertsPerFace = sizes.data();
  descriptor.vertIndicesPerFace = corners.data();
  descriptor.numCorners = static_cast<int>(sharp.size());
  descriptor.cornerVertexIndices = sharp_vertices.data();
  descriptor.cornerWeights = sharpness.data();
  OpenSubdiv::Sdc::Options boundary;
  boundary.SetVtxBoundaryInterpolation(OpenSubdiv::Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  using Factory = OpenSubdiv::Far::TopologyRefinerFactory<TopologyDescriptor>;
  std::unique_ptr<TopologyRefiner> refiner(
      Factory::Create(descriptor, Factory::Options(OpenSubdiv::Sdc::SCHEME_LOOP, boundary)));
  if (!refiner) throw bad("OpenSubdiv refuses it");
  TopologyRefiner::UniformOptions uniform(static_cast<unsigned int>(levels));
  uniform.fullTopologyInLastLevel = true;  // limit masks need the faces around its vertices
  refiner->RefineUniform(uniform);
  return refiner;
}

// Takes the place of a vertex's value in OpenSubdiv, and records the weights it is computed with.
struct Recorder {
  std::vector<LoopWeight> weights;
  void Clear() { weights.clear(); }
  void AddWithWeight(std::uint32_t vertex, double weight) {
    if (weight != 0) weights.push_back({vertex, weight});
  }
  // For points inside faces, which only schemes other than Loop's have.
  void AddWithWeight(const Recorder& other, double weight) {
    for (const LoopWeight& w : other.weights) AddWithWeight(w.vertex, weight * w.weight);
  }
};

struct VertexIds {
  std::uint32_t operator[](int i) const { return static_cast<std::uint32_t>(i); }
};

Rows<LoopWeight> rows_of(const std::vector<Recorder>& recorders) {
  Rows<LoopWeight> rows;
  std::size_t total = 0;
  for (const Recorder& r : recorders) total += r.weights.size();
  rows.items.reserve(total);
  rows.offsets.reserve(recorders.size() + 1);
  for (const Recorder& r : recorders) {
    rows.items.insert(rows.items.end(), r.weights.begin(), r.weights.end());
    rows.offsets.push_back(static_cast<std::uint32_t>(rows.items.size()));
  }
  return rows;
}

void take_faces(const OpenSubdiv::Far::TopologyLevel& from, LoopLevel& level) {
  level.vertex_count = static_cast<std::uint32_t>(from.GetNumVertices());
  for (Index f = 0; f < from.GetNumFaces(); ++f) {
    const auto vertices = from.GetFaceVertices(f), edges = from.GetFaceEdges(f);
    std::array<std::uint32_t, 3> face{}, across{};
    for (int s = 0; s < 3; ++s) {
      const auto side = static_cast<std::size_t>(s);
      face[side] = static_cast<std::uint32_t>(vertices[s]);
      across[side] = LoopLevel::none;
      const auto both = from.GetEdgeFaces(edges[s]);
      const auto where = from.GetEdgeFaceLocalIndices(edges[s]);
      for (int k = 0; k < both.size(); ++k) {
        if (both[k] != f) across[side] = 3 * static_cast<std::uint32_t>(both[k]) + where[k];
      }
    }
    level.faces.push_back(face);
    level.across.push_back(across);
  }
}

void take_parents(const OpenSubdiv::Far::TopologyLevel& before, const OpenSubdiv::Far::TopologyLevel& now,
                  LoopLevel& level) {
  for (Index f = 0; f < now.GetNumFaces(); ++f) {
    const Index parent = now.GetFaceParentFace(f);
    const auto vertices = before.GetFaceVertices(parent), edges = before.GetFaceEdges(parent);
    std::array<std::uint8_t, 3> place{};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto v = static_cast<Index>(level.faces[static_cast<std::size_t>(f)][c]);
      for (int i = 0; i < 3; ++i) {
        if (before.GetVertexChildVertex(vertices[i]) == v) place[c] = static_cast<std::uint8_t>(i);
        if (before.GetEdgeChildVertex(edges[i]) == v) place[c] = static_cast<std::uint8_t>(3 + i);
      }
    }
    level.parent.push_back(static_cast<std::uint32_t>(parent));
    level.place.push_back(place);
  }
}

}  // namespace

LoopSubdivision subdivide_loop(const Faces& faces, std::uint32_t vertex_count, int levels,
                               const std::vector<std::uint32_t>& sharp) {
  check_manifold(faces, vertex_count);
  LoopSubdivision result;
  if (faces.empty()) throw bad("there are no faces");
  const auto refiner = refiner_of(faces, vertex_count, levels, sharp);
  const OpenSubdiv::Far::PrimvarRefinerReal<double> masks(*refiner);
  for (int l = 0; l <= levels; ++l) {
    const auto at = refiner->GetLevel(l);
    LoopLevel& level = result.levels.emplace_back();
    take_faces(at, level);
    if (l == 0) continue;
    std::vector<Recorder> recorders(level.vertex_count);
    masks.Interpolate(l, VertexIds{}, recorders);
    level.masks = rows_of(recorders);
    take_parents(refiner->GetLevel(l - 1), at, level);
  }
  std::vector<Recorder> limit(result.levels.back().vertex_count), first(limit.size()), second(limit.size());
  masks.Limit(VertexIds{}, limit, first, second);
  result.limit = rows_of(limit);
  result.tangents = {rows_of(first), rows_of(second)};
  return result;
}

}  // namespace plisse
