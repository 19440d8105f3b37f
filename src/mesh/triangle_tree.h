// The triangles of a surface in a tree of boxes: which are near a point, and what a straight way meets first.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace plisse {

// The point of a triangle (corners: columns) nearest to `p`, by its weights on the corners. Where it lies on
// an edge or a corner the other weights are exactly 0. (C. Ericson, Real-Time Collision Detection, 5.1.5.)
Eigen::Vector3d nearest_weights(const Eigen::Matrix3d& corners, const Eigen::Vector3d& p);

class TriangleTree {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  TriangleTree(Eigen::Matrix3Xd points, std::vector<Triangle> triangles);

  const Eigen::Matrix3Xd& points() const { return points_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const Eigen::AlignedBox3d& box() const { return nodes_.front().box; }
  Eigen::Matrix3d corners(std::uint32_t triangle) const;

  struct Nearest {
    static constexpr std::uint32_t nothing = ~std::uint32_t{0};
    std::uint32_t triangle = nothing;
    Eigen::Vector3d weights = Eigen::Vector3d::Zero(), point = Eigen::Vector3d::Zero();
    double distance = std::numeric_limits<double>::infinity();
  };
  // Of those within `reach`; `nothing` where there is none.
  Nearest nearest(const Eigen::Vector3d& p, double reach = std::numeric_limits<double>::infinity()) const;

  // Calls visit(triangle) for every triangle that may come within `reach` of p.
  template <typename Visit>
  void each_near(const Eigen::Vector3d& p, double reach, const Visit& visit) const {
    walk(
        0, [&](const Node& node) { return node.box.squaredExteriorDistance(p) <= reach * reach; }, visit);
  }

  // The share of the straight way at which it meets a triangle first, from either side; infinite where it
  // meets none on the way.
  double first_hit(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

 private:
  struct Node {  // a leaf where count > 0: order_[first …]; else its halves are first and first + 1
    Eigen::AlignedBox3d box;
    std::uint32_t first = 0, count = 0;
  };
  void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end, const Eigen::Matrix3Xd& middles);
  template <typename Enter, typename Visit>
  void walk(std::uint32_t index, const Enter& enter, const Visit& visit) const {
    const Node& node = nodes_[index];
    if (!enter(node)) return;
    if (node.count == 0) {
      walk(node.first, enter, visit);
      walk(node.first + 1, enter, visit);
    }
    for (std::uint32_t k = 0; k < node.count; ++k) visit(order_[node.first + k]);
  }
  void nearest_in(std::uint32_t index, const Eigen::Vector3d& p, Nearest& best) const;

  Eigen::Matrix3Xd points_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace plisse
