#include "shell/topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "base/error.h"

namespace plisse::shell {
namespace {

struct Side {
  std::array<std::uint32_t, 2> vertex;
  std::uint32_t face;
  std::uint8_t corner;  // the one opposite to it
  bool forward;         // the face runs from vertex[0] to vertex[1]
};

// Names the first few and counts the rest.
class Problems {
 public:
  void add(const std::string& text) {
    if (++count_ <= 5) text_ += (text_.empty() ? "" : "; ") + text;
  }
  void throw_if_any() const {
    if (count_ == 0) return;
    const std::string more = count_ > 5 ? fmt::format("; and {} more", count_ - 5) : "";
    throw Error(ExitCode::bad_input, fmt::format("the mesh is no shell: {}{}", text_, more));
  }

 private:
  std::string text_;
  std::size_t count_ = 0;
};

std::vector<Side> sides_of(const std::vector<Face>& faces) {
  std::vector<Side> sides;
  sides.reserve(3 * faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f)
    for (std::uint8_t i = 0; i < 3; ++i) {
      const std::uint32_t a = faces[f][(i + 1) % 3], b = faces[f][(i + 2) % 3];
      sides.push_back({{std::min(a, b), std::max(a, b)}, f, i, a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tuple(a.vertex, !a.forward, a.face) < std::tuple(b.vertex, !b.forward, b.face);
  });
  return sides;
}

void number_components(Topology& topology) {
  std::vector<std::uint32_t> parent(topology.vertex_count);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Edge& edge : topology.edges) parent[root(edge.vertex[0])] = root(edge.vertex[1]);
  std::vector<bool> used(topology.vertex_count, false);
  for (const Face& face : topology.faces)
    for (const std::uint32_t v : face) used[v] = true;
  std::vector<std::uint32_t> number(topology.vertex_count, none);
  topology.component.assign(topology.vertex_count, none);
  for (std::uint32_t v = 0; v < topology.vertex_count; ++v) {
    if (!used[v]) continue;
    std::uint32_t& component = number[root(v)];
    if (component == none) component = topology.component_count++;
    topology.component[v] = component;
  }
}

}  // namespace

Topology build_topology(std::vector<Face> faces, std::size_t vertex_count) {
  Problems problems;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto [a, b, c] = faces[f];
    if (std::max({a, b, c}) >= vertex_count)
      problems.add(
          fmt::format("face {} names vertex {}, and there are {}", f, std::max({a, b, c}), vertex_count));
    else if (a == b || b == c || c == a)
      problems.add(fmt::format("face {} names a vertex twice ({}, {}, {})", f, a, b, c));
  }
  problems.throw_if_any();

  Topology topology;
  topology.vertex_count = static_cast<std::uint32_t>(vertex_count);
  topology.faces = std::move(faces);
  topology.face_edges.resize(topology.faces.size());
  topology.flaps.assign(topology.faces.size(), {none, none, none});
  const std::vector<Side> sides = sides_of(topology.faces);
  for (std::size_t first = 0, last; first < sides.size(); first = last) {
    for (last = first + 1; last < sides.size() && sides[last].vertex == sides[first].vertex;) ++last;
    const auto [a, b] = sides[first].vertex;
    if (last - first > 2) {
      problems.add(fmt::format("edge {}-{} has {} faces, more than two", a, b, last - first));
    } else if (last - first == 2 && sides[first].forward == sides[first + 1].forward) {
      problems.add(fmt::format("faces {} and {} run along edge {}-{} the same way", sides[first].face,
                               sides[first + 1].face, a, b));
    }
    Edge edge{{a, b}};
    for (std::size_t s = first; s < std::min(last, first + 2); ++s) {
      const Side& side = sides[s];
      edge.face[s - first] = side.face;
      edge.opposite[s - first] = topology.faces[side.face][side.corner];
      topology.face_edges[side.face][side.corner] = static_cast<std::uint32_t>(topology.edges.size());
    }
    if (last - first == 2) {
      topology.flaps[sides[first].face][sides[first].corner] = edge.opposite[1];
      topology.flaps[sides[first + 1].face][sides[first + 1].corner] = edge.opposite[0];
    }
    topology.edges.push_back(edge);
  }
  problems.throw_if_any();
  number_components(topology);
  return topology;
}

}  // namespace plisse::shell
