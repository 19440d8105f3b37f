#include "shell/block_matrix.h"

#include <Eigen/OrderingMethods>
#include <algorithm>

namespace plisse::shell {

BlockMatrix::BlockMatrix(const std::vector<Pair>& pairs, const Topology& topology,
                         const Conditions& conditions) {
  number_unknowns(pairs, topology, conditions);
  build_pattern(pairs);
}

void BlockMatrix::number_unknowns(const std::vector<Pair>& pairs, const Topology& topology,
                                  const Conditions& conditions) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(2 * pairs.size());
  for (const auto& [a, b] : pairs) {
    entries.emplace_back(static_cast<int>(a), static_cast<int>(b), 1.0);
    entries.emplace_back(static_cast<int>(b), static_cast<int>(a), 1.0);
  }
  const auto vertex_count = static_cast<Eigen::Index>(topology.vertex_count);
  Eigen::SparseMatrix<double> graph(vertex_count, vertex_count);
  graph.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;  // new place → vertex
  Eigen::AMDOrdering<int>()(graph, order);
  place_.resize(topology.vertex_count);
  unknown_.assign(topology.vertex_count, {-1, -1, -1});
  for (std::uint32_t place = 0; place < topology.vertex_count; ++place) {
    const auto v = static_cast<std::uint32_t>(order.indices()[place]);
    place_[v] = place;
    if (topology.component[v] == none) continue;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      if (conditions.held(axis, v)) continue;
      unknown_[v][axis] = static_cast<std::int32_t>(scalar_.size());
      scalar_.push_back(3 * v + axis);
    }
  }
}

void BlockMatrix::build_pattern(const std::vector<Pair>& pairs) {
  std::vector<Pair> places;  // (column, row)
  places.reserve(pairs.size());
  for (const auto& [a, b] : pairs)
    places.emplace_back(std::min(place_[a], place_[b]), std::max(place_[a], place_[b]));
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());

  const auto vertex_count = static_cast<std::uint32_t>(place_.size());
  std::vector<std::uint32_t> vertex_at(vertex_count);
  for (std::uint32_t v = 0; v < vertex_count; ++v) vertex_at[place_[v]] = v;
  first_block_.assign(vertex_count + 1, 0);
  blocks_.resize(places.size());
  for (std::size_t b = 0; b < places.size(); ++b) {
    blocks_[b] = {places[b].second, places[b].first, {-1, -1, -1, -1, -1, -1, -1, -1, -1}};
    ++first_block_[places[b].first + 1];
  }
  for (std::size_t c = 0; c < vertex_count; ++c) first_block_[c + 1] += first_block_[c];

  const auto unknowns = static_cast<Eigen::Index>(scalar_.size());
  std::vector<int> outer(scalar_.size() + 1, 0), inner;
  std::int32_t slot = 0;
  std::size_t column_unknown = 0;
  for (std::uint32_t column = 0; column < vertex_count; ++column)
    for (std::size_t c = 0; c < 3; ++c) {
      if (unknown_[vertex_at[column]][c] < 0) continue;
      for (std::uint32_t b = first_block_[column]; b < first_block_[column + 1]; ++b)
        for (std::size_t r = 0; r < 3; ++r) {
          const std::int32_t row = unknown_[vertex_at[blocks_[b].row]][r];
          if (row < unknown_[vertex_at[column]][c]) continue;  // held, or in the upper half
          blocks_[b].slot[3 * r + c] = slot++;
          inner.push_back(row);
        }
      outer[++column_unknown] = slot;
    }
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(slot);
  lower_ = Eigen::Map<const Eigen::SparseMatrix<double>>(unknowns, unknowns, slot, outer.data(), inner.data(),
                                                         zero.data());
}

std::uint32_t BlockMatrix::block(std::uint32_t a, std::uint32_t b) const {
  const std::uint32_t column = std::min(place_[a], place_[b]), row = std::max(place_[a], place_[b]);
  const auto first = blocks_.begin() + first_block_[column],
             last = blocks_.begin() + first_block_[column + 1];
  return static_cast<std::uint32_t>(
      std::lower_bound(first, last, row, [](const Block& block, std::uint32_t r) { return block.row < r; }) -
      blocks_.begin());
}

void BlockMatrix::add(std::uint32_t block, std::uint32_t a, std::uint32_t b, const Eigen::Matrix3d& values) {
  const bool turned = place_[a] < place_[b];
  double* into = lower_.valuePtr();
  const auto& slot = blocks_[block].slot;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      const std::int32_t at = slot[static_cast<std::size_t>(3 * r + c)];
      if (at >= 0) into[at] += turned ? values(c, r) : values(r, c);
    }
}

}  // namespace plisse::shell
