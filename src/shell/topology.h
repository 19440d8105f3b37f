// Edges and flaps (opposite vertices) of the triangles of a shell.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace plisse::shell {

using Face = std::array<std::uint32_t, 3>;

inline constexpr std::uint32_t none = ~std::uint32_t{0};

// Edges are (smaller, larger) vertex pairs in lexicographic order.
struct Edge {
  std::array<std::uint32_t, 2> vertex{};
  std::array<std::uint32_t, 2> face{none,
                                    none};  // the first: where the edge runs from vertex[0] to vertex[1]
                                            // if there is such a face; the second none on a boundary
  std::array<std::uint32_t, 2> opposite{none, none};  // the third vertex of each face
  bool boundary() const { return face[1] == none; }
};

struct Topology {
  std::uint32_t vertex_count = 0;
  std::vector<Face> faces;
  std::vector<Edge> edges;
  std::vector<std::array<std::uint32_t, 3>> face_edges;  // edge i of a face is opposite to its corner i
  std::vector<std::array<std::uint32_t, 3>> flaps;       // the vertex across edge i, none on a boundary
  std::vector<std::uint32_t> component;  // of each vertex, counted from 0; none where no face uses it
  std::uint32_t component_count = 0;
};

// Throws Error(bad_input), all problems at once (the first few of them by number): a face with a missing
// vertex or with one vertex twice; an edge with more than two faces; two faces with the same direction along
// an edge, so that the shell is not orientable.
Topology build_topology(std::vector<Face> faces, std::size_t vertex_count);

}  // namespace plisse::shell
