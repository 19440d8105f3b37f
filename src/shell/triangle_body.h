// A solid bounded by triangles, such as a person's body: signed distance, a barrier, and intersections with
// straight paths.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mesh/triangle_tree.h"
#include "shell/barrier.h"

namespace plisse::shell {

class TriangleBody {
 public:
  // Closed: every edge has two triangles. All triangles must have the same orientation, either of the two;
  // the larger side is outside. Throws Error(bad_input), with `name` in front, where it is open (an edge is
  // named), has edges of more than two triangles, mixed orientations, or no interior.
  TriangleBody(Eigen::Matrix3Xd points, std::vector<TriangleTree::Triangle> triangles,
               const std::string& name);

  // Metres, positive outside; `first` leads out. Sign by the angle-weighted normals of faces, edges and
  // vertices (J. A. Bærentzen and H. Aanæs, TVCG 2005), with which it is right everywhere.
  Distance distance(const Eigen::Vector3d& point) const;

  // The barrier of the body, which is smooth also where the distance is not (above concave and convex edges):
  //   Σ_faces b(d) − Σ_edges b(d) + Σ_vertices b(d),
  // d to each of them, b of barrier.h. On flat and convex parts all but the nearest element cancel; in
  // concave places both sides push (M. Li et al., Convergent Incremental Potential Contact, 2023). Infinite
  // inside.
  Contact contact(const Eigen::Vector3d& point, double gap, bool curvature) const;

  // The share, at most 1, of a straight path that does not pass through a triangle.
  double free_way(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  const TriangleTree& tree() const { return tree_; }

 private:
  Eigen::Vector3d normal_at(const TriangleTree::Nearest& nearest) const;

  TriangleTree tree_;
  Eigen::Matrix3Xd face_normals_;              // unit
  std::vector<Eigen::Matrix3d> edge_normals_;  // of each face: column i, of the edge opposite to its corner i
  Eigen::Matrix3Xd vertex_normals_;            // angle-weighted sums
  Eigen::VectorXd valence_;                    // of each vertex
};

}  // namespace plisse::shell
