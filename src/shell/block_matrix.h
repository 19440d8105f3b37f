// A sparse symmetric matrix over the free coordinates of a shell's vertices: the Hessian of its energy. It is
// made of 3×3 blocks, one a pair of vertices, and its pattern stays what it is when values change.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "shell/statics.h"

namespace plisse::shell {

// Unknowns are the coordinates that are not held, of vertices with faces. Vertices are numbered so that
// factors stay sparse (approximate minimum degree on the vertices' own graph: a third of the size of the
// matrix, so a ninth of the work).
class BlockMatrix {
 public:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  // A block for each of these pairs of vertices, in either order, once or several times.
  BlockMatrix(const std::vector<Pair>& pairs, const Topology& topology, const Conditions& conditions);

  // 3·vertex + axis of each unknown.
  const std::vector<std::uint32_t>& scalars() const { return scalar_; }

  // The number of the block of a pair, which must be among those of the constructor.
  std::uint32_t block(std::uint32_t a, std::uint32_t b) const;
  // Adds to it a matrix with rows by `a` and columns by `b`.
  void add(std::uint32_t block, std::uint32_t a, std::uint32_t b, const Eigen::Matrix3d& values);

  Eigen::Map<Eigen::VectorXd> values() { return {lower_.valuePtr(), lower_.nonZeros()}; }
  const Eigen::SparseMatrix<double>& lower() const { return lower_; }  // its lower half, diagonal included

 private:
  struct Block {  // rows ≥ columns in the order of elimination
    std::uint32_t row = 0, column = 0;
    // Into the values by 3·row + column, −1: not in the lower half or held.
    std::array<std::int32_t, 9> slot{};
  };
  void number_unknowns(const std::vector<Pair>& pairs, const Topology& topology,
                       const Conditions& conditions);
  void build_pattern(const std::vector<Pair>& pairs);

  std::vector<std::uint32_t> place_;                  // of a vertex in the order of elimination
  std::vector<std::uint32_t> scalar_;                 // of each unknown
  std::vector<std::array<std::int32_t, 3>> unknown_;  // of each vertex and axis, −1: held
  std::vector<Block> blocks_;                         // sorted by column, then row
  std::vector<std::uint32_t> first_block_;            // of each column
  Eigen::SparseMatrix<double> lower_;
};

}  // namespace plisse::shell
