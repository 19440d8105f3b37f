// The potential energy of a shell under its loads, its gradient and its sparse Hessian.
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

#include "shell/bending_midedge.h"
#include "shell/friction.h"
#include "shell/statics.h"

namespace plisse::shell {

// Which scalar unknowns there are: those of no vertex are held, and vertices without faces have none.
// Vertices are numbered so that factors stay sparse (approximate minimum degree on the vertices' own graph: a
// third of the size of the matrix, so a ninth of the work).
class Potential {
 public:
  // Keeps references. Which coordinates are held is fixed from here on, where to is not. `origin`: where
  // gravity and dead forces have no energy and bending is measured from; near the shell rounding is least.
  // Forces do not depend on it, and offset() is what energies lack beside those from the world's origin.
  Potential(const Shell& shell, const Conditions& conditions, const Loads& loads,
            const Eigen::Vector3d& origin = Eigen::Vector3d::Zero());
  double offset() const { return offset_; }

  Eigen::Index unknowns() const { return static_cast<Eigen::Index>(scalar_.size()); }

  struct Value {
    double energy = 0;       // J; infinite where a vertex is inside an obstacle
    double friction = 0;     // J, a part of it: the work against what grips, since the anchors
    double terms = 0;        // sum of the summands' absolute values, J: what rounding is relative to
    double force_scale = 0;  // N: largest sum of absolute forces of elements and loads on a vertex
  };
  // `gradient`: one entry an unknown, N.
  Value value(const Positions& x, Eigen::VectorXd* gradient = nullptr) const;

  // The lower half, with the same pattern every time. `positive`: without the parts that may have negative
  // curvature: compression, normals' own curvature, pressure, obstacles' concave directions.
  const Eigen::SparseMatrix<double>& hessian(const Positions& x, Curvature curvature);

  // Looks at what obstacles push at, which friction goes by from here on: the energy changes by it. A vertex
  // that is newly in contact grips where it is, those of `first` where Loads::anchors says.
  void grip(const Positions& x, bool first);
  // Where vertices stick from here on, to each obstacle (Loads::anchors): what has slipped drags its anchor
  // along.
  std::vector<Positions> anchors(const Positions& x) const;

  // Adds `step` times the unknowns' direction to the positions.
  void advance(Positions& x, const Eigen::VectorXd& direction, double step) const;
  // Rest area of the vertex of each unknown, m².
  const Eigen::VectorXd& areas() const { return unknown_areas_; }
  // The longest step ≤ 1 along a direction on which no vertex can pass through an obstacle (free_way).
  double safe_step(const Positions& x, const Eigen::VectorXd& direction) const;

 private:
  struct Block {  // of two vertices, rows ≥ columns in the order of elimination
    std::uint32_t row = 0, column = 0;
    std::array<std::int32_t, 9>
        slot{};  // into the values by 3·row + column, −1: not in the lower half or held
  };
  struct Flap {
    Corners across = Corners::Zero();
    std::array<bool, 3> has{};
  };
  void number_unknowns(const Conditions& conditions);
  void build_pattern();
  std::uint32_t block_of(std::uint32_t a, std::uint32_t b) const;
  // Adds a 3×3 matrix to the block; `turned`: it stands for (column, row).
  void add(std::uint32_t block, const Eigen::Matrix3d& values, bool turned);
  // Adds a face's matrix, of its corners and (6) the vertices across its edges.
  template <int Vertices>
  void scatter(std::size_t face, const Eigen::Matrix<double, 3 * Vertices, 3 * Vertices>& element,
               const std::vector<std::uint32_t>& blocks);
  Matrix9 stretching_hessian(std::size_t face, const Positions& x,
                             Curvature curvature) const;  // and pressure's
  // −p V and its derivative. Corners get a third of their faces' load each; what the cones' open sides add
  // along the boundary is no force of the sheet, so it counts as none in `size`.
  double pressure_energy(const Positions& x, Positions* sum, Positions* size) const;
  Eigen::Vector3d dead_force(std::uint32_t vertex) const;
  // Where the cones under a part's faces meet: anywhere if it is closed, else the place check() asks for.
  Eigen::Vector3d apex(std::uint32_t part, const Positions& x) const;
  Flap flap_of(std::size_t face, const Positions& x) const;
  // Bending of one face by mid-edge normals, J. Rows of a mirrored vertex, which has the corner's own place
  // in the stencil, are by the corner.
  double midedge(std::size_t face, const Positions& x, Vector18* gradient, Matrix18* hessian,
                 Curvature curvature) const;
  // All obstacles on one vertex, J and its derivatives; on all vertices, or nothing where there are none.
  Contact contact_at(std::uint32_t vertex, const Eigen::Vector3d& x, bool curvature) const;
  std::vector<Contact> contacts(const Positions& x, bool curvature) const;

  std::vector<Grip> grips_;

  const Shell& shell_;
  const Loads& loads_;
  StretchingLaw law_;
  Eigen::VectorXd vertex_areas_, unknown_areas_;
  double contact_ = 0;  // N/m³
  Eigen::Vector3d origin_;
  double offset_ = 0;  // J
  std::vector<Conditions::Mirror> mirrors_;
  std::vector<std::array<std::int8_t, 3>> mirrored_;      // of each face's edges: which mirror, −1: none
  std::vector<OpenSide> open_sides_;                      // of each part
  std::vector<std::uint32_t> some_vertex_;                // of each part
  std::vector<std::uint32_t> place_;                      // of a vertex in the order of elimination
  std::vector<std::uint32_t> scalar_;                     // 3·vertex + axis of each unknown
  std::vector<std::array<std::int32_t, 3>> unknown_;      // of each vertex and axis, −1: held
  Eigen::SparseMatrix<double> quadratic_;                 // V×V, or empty
  Eigen::SparseMatrix<double> quadratic_sizes_;           // absolute values of the same
  std::vector<Block> blocks_;                             // sorted by column, then row
  std::vector<std::uint32_t> first_block_;                // of each column
  std::vector<std::uint32_t> face_blocks_, flap_blocks_;  // 6 or 21 a face: pairs (k ≥ l) of its vertices
  Eigen::SparseMatrix<double> matrix_;
  Eigen::VectorXd constant_;  // the quadratic bending's own values, which never change
};

}  // namespace plisse::shell
