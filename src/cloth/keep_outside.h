// Base surfaces that stay outside bodies, not only with their vertices: the smooth surface that is drawn, and
// the mesh's own triangles; and how high waves may be on them.
#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <vector>

#include "shell/follow.h"
#include "shell/triangle_body.h"
#include "wrinkle/surface.h"

namespace plisse::cloth {

// Points of a shell as combinations of its vertices: the mesh's vertices and middles of edges, and where
// these are on Loop's limit surface.
class ShellPoints {
 public:
  ShellPoints(const shell::Topology& topology, const std::vector<shell::RestFace>& rest);

  Eigen::Index count() const { return weights_.rows(); }
  Eigen::Matrix3Xd at(const shell::Positions& vertices) const;  // m
  Eigen::VectorXd at(const Eigen::VectorXd& values) const;      // of the vertices
  // Of one point: which vertices, with what weights.
  std::vector<std::pair<std::uint32_t, double>> of(Eigen::Index point) const;

 private:
  Eigen::SparseMatrix<double, Eigen::RowMajor> weights_;
};

using Bodies = std::vector<const shell::TriangleBody*>;

// How far the points of a pose are from the nearest body, m, negative inside; so that those of a surface near
// the pose need not all be asked for.
struct Clearance {
  Clearance(const ShellPoints& points, const shell::Positions& pose, const Bodies& bodies);
  // Of a point that has moved to `here`, at least.
  double least(Eigen::Index point, const Eigen::Vector3d& here) const {
    return distance[static_cast<std::size_t>(point)] - (here - places.col(point)).norm();
  }
  Eigen::Matrix3Xd places;
  std::vector<double> distance;
};

struct KeptOutside {
  shell::Followed followed;
  bool outside = true;  // no point is much nearer to a body than it should be
};

// The base surface of a pose with all points outside bodies by `gap`, and by `lift`, m, a value a vertex
// (empty: none), more. Half-spaces are those of the pose's own nearest body points, so that one minimum is
// left, whatever the search does; only where these are not enough, as on a concave body, those of the surface
// that was found. Points that begin inside a body are brought out.
KeptOutside follow_outside(const shell::Follower& follower, const ShellPoints& points,
                           const shell::Positions& pose, const Clearance& clearance, const Bodies& bodies,
                           double gap, const Eigen::VectorXd& lift);

// m, one a vertex: how high waves may be there without touching a body; infinite where none is within
// `reach`. nearest: becomes the smallest distance of a point, m, where it was larger.
std::vector<double> room_of(const ShellPoints& points, const Clearance& clearance,
                            const shell::Positions& base, const Bodies& bodies, double reach,
                            double& nearest);

// m, one a vertex: how high waves would be by the surface's own strain and curvature, each face for itself,
// none longer than the middle one.
Eigen::VectorXd wanted_heights(const wrinkle::BaseSurface& surface,
                               const std::vector<wrinkle::FaceForms>& forms, const shell::Material& material);

}  // namespace plisse::cloth
