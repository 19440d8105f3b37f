// Data that skin, crush and relax of the reference share: the welded mesh and its frames, in double
// precision.
//
// Arrays are 3 × V, one column a welded vertex. Lengths are in any one unit (docs/passes.md, "Units").
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <vector>

#include "mesh/surface.h"

namespace plisse::reference {

struct Topology {
  Eigen::Matrix3Xd rest;           // rest positions x
  Rows<std::uint32_t> neighbours;  // over triangle edges, ascending ids, symmetric, no loops
  Rows<Corner> corners;            // the triangles around a vertex

  Eigen::Index size() const { return rest.cols(); }
};

// Orthonormal tangent frames; the third vector is b = n × t.
struct Frames {
  Eigen::Matrix3Xd normal;   // n, unit
  Eigen::Matrix3Xd tangent;  // t, unit, perpendicular to n

  // (t, b) of one vertex: takes components in the tangent plane to the world; its transpose takes them back.
  Eigen::Matrix<double, 3, 2> basis(Eigen::Index vertex) const {
    Eigen::Matrix<double, 3, 2> tb;
    tb.col(0) = tangent.col(vertex);
    tb.col(1) = normal.col(vertex).cross(tangent.col(vertex));
    return tb;
  }
};

// The entries of one row, for range-for.
template <typename Item>
struct RowView {
  const Item* first;
  const Item* last;
  const Item* begin() const { return first; }
  const Item* end() const { return last; }
  std::size_t size() const { return static_cast<std::size_t>(last - first); }
};

template <typename Item>
RowView<Item> row(const Rows<Item>& rows, Eigen::Index vertex) {
  const auto v = static_cast<std::size_t>(vertex);
  return {rows.items.data() + rows.offsets[v], rows.items.data() + rows.offsets[v + 1]};
}

}  // namespace plisse::reference
