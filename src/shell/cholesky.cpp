#include "shell/cholesky.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <numeric>

#include "shell/dense.h"

namespace plisse::shell {
namespace {

using Eigen::MatrixXd;
using Index = std::int32_t;

// The elimination tree of a lower half by columns: the parent of a column is the first row below it in L (Liu
// 1986).
std::vector<Index> elimination_tree(const Eigen::SparseMatrix<double>& lower) {
  const auto count = static_cast<std::size_t>(lower.cols());
  std::vector<std::vector<Index>> left(count);  // columns with a number in this row
  for (Index column = 0; column < lower.cols(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(lower, column); it; ++it)
      if (it.row() > column) left[static_cast<std::size_t>(it.row())].push_back(column);
  std::vector<Index> parent(count, -1), ancestor(count, -1);
  for (std::size_t row = 0; row < count; ++row)
    for (Index column : left[row])
      while (column >= 0 && column < static_cast<Index>(row)) {
        const auto at = static_cast<std::size_t>(column);
        const Index next = ancestor[at];
        ancestor[at] = static_cast<Index>(row);
        if (next < 0) parent[at] = static_cast<Index>(row);
        column = next;
      }
  return parent;
}

// Children right before their parents.
std::vector<Index> postorder(const std::vector<Index>& parent) {
  const std::size_t count = parent.size();
  std::vector<Index> head(count + 1, -1), next(count, -1), order;
  for (std::size_t v = count; v-- > 0;) {
    const std::size_t at = parent[v] < 0 ? count : static_cast<std::size_t>(parent[v]);
    next[v] = head[at];
    head[at] = static_cast<Index>(v);
  }
  order.reserve(count);
  std::vector<Index> stack;
  for (Index root = head[count]; root >= 0; root = next[static_cast<std::size_t>(root)]) {
    stack.push_back(root);
    while (!stack.empty()) {
      const auto top = static_cast<std::size_t>(stack.back());
      if (head[top] >= 0) {
        stack.push_back(head[top]);
        head[top] = next[static_cast<std::size_t>(head[top])];
      } else {
        order.push_back(stack.back());
        stack.pop_back();
      }
    }
  }
  return order;
}

std::vector<Index> merged(const std::vector<Index>& a, const std::vector<Index>& b) {
  std::vector<Index> all;
  all.reserve(a.size() + b.size());
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
  return all;
}

// Whether to merge two neighbouring supernodes, given the number of zeros among all numbers.
bool worth_merging(std::size_t width, double zeros, double numbers) {
  const double share = zeros / numbers;
  return width <= 12 ? share < 0.8 : width <= 48 ? share < 0.2 : share < 0.05;
}

}  // namespace

void Cholesky::analyse(const Eigen::SparseMatrix<double>& lower) {
  const auto count = static_cast<std::size_t>(lower.cols());
  const std::vector<Index> tree = elimination_tree(lower), order = postorder(tree);
  place_.assign(count, 0);
  for (std::size_t k = 0; k < count; ++k) place_[static_cast<std::size_t>(order[k])] = static_cast<Index>(k);

  // Rows of every column in its new place; an ancestor keeps its place behind its descendants.
  std::vector<std::vector<Index>> below(count);
  for (Index column = 0; column < lower.cols(); ++column) {
    auto& rows = below[static_cast<std::size_t>(place_[static_cast<std::size_t>(column)])];
    for (Eigen::SparseMatrix<double>::InnerIterator it(lower, column); it; ++it)
      if (it.row() != column) rows.push_back(place_[static_cast<std::size_t>(it.row())]);
    std::sort(rows.begin(), rows.end());
  }

  // Supernodes from left to right: a column whose rows are those of the one before, but for itself, joins it.
  nodes_.clear();
  node_of_.assign(count, 0);
  std::vector<std::vector<std::uint32_t>> waiting(count);  // supernodes whose parent column this is
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<Index> rows = std::move(below[k]);
    for (const std::uint32_t child : waiting[k]) {
      const auto& theirs = nodes_[child].rows;
      rows = merged(rows, {theirs.begin() + 1, theirs.end()});  // their first row is this column
    }
    const bool follows = waiting[k].size() == 1 && waiting[k][0] + 1 == nodes_.size() &&
                         nodes_.back().rows.size() == rows.size() + 1;
    if (follows) {
      ++nodes_.back().width;
      nodes_.back().rows = std::move(rows);
    } else {
      Supernode node;
      node.first = static_cast<Index>(k);
      node.width = 1;
      node.rows = std::move(rows);
      node.children = waiting[k];
      // The last child lies right before: one with it, where few zeros come of it.
      while (!node.children.empty()) {
        const Supernode& last = nodes_[node.children.back()];
        if (node.children.back() + 1 != nodes_.size()) break;
        const auto w = static_cast<double>(last.width), r = static_cast<double>(last.rows.size());
        const double extra = w * (static_cast<double>(node.height()) - r);
        const double total = (w + static_cast<double>(node.width)) * (w + static_cast<double>(node.height()));
        if (!worth_merging(static_cast<std::size_t>(last.width + node.width), extra, total)) break;
        node.first = last.first;
        node.width += last.width;
        node.children.pop_back();
        node.children.insert(node.children.end(), last.children.begin(), last.children.end());
        std::sort(node.children.begin(), node.children.end());
        nodes_.pop_back();
      }
      nodes_.push_back(std::move(node));
    }
    const auto self = static_cast<std::uint32_t>(nodes_.size() - 1);
    if (!nodes_[self].rows.empty())
      waiting[static_cast<std::size_t>(nodes_[self].rows.front())].push_back(self);
    waiting[k].clear();
  }

  std::size_t size = 0;
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    Supernode& node = nodes_[n];
    node.panel = size;
    size += node.height() * static_cast<std::size_t>(node.width);
    for (Index k = 0; k < node.width; ++k) node_of_[static_cast<std::size_t>(node.first + k)] = n;
  }
  panels_.assign(size, 0);
  const auto place_in = [](const Supernode& node, Index row) {
    if (row < node.first + node.width) return row - node.first;
    return node.width +
           static_cast<Index>(std::lower_bound(node.rows.begin(), node.rows.end(), row) - node.rows.begin());
  };
  for (Supernode& node : nodes_) node.children.clear();
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    Supernode& node = nodes_[n];
    if (node.rows.empty()) continue;
    const std::uint32_t parent = node_of_[static_cast<std::size_t>(node.rows.front())];
    node.parent = parent;
    nodes_[parent].children.push_back(n);
    node.into_parent.clear();
    for (const Index row : node.rows) node.into_parent.push_back(place_in(nodes_[parent], row));
  }

  // Where each number of the matrix goes.
  first_slot_.assign(nodes_.size() + 1, 0);
  for (Index column = 0; column < lower.cols(); ++column)
    first_slot_[node_of_[static_cast<std::size_t>(place_[static_cast<std::size_t>(column)])] + 1] +=
        static_cast<std::size_t>(lower.outerIndexPtr()[column + 1] - lower.outerIndexPtr()[column]);
  std::partial_sum(first_slot_.begin(), first_slot_.end(), first_slot_.begin());
  slots_.resize(first_slot_.back());
  numbers_.resize(first_slot_.back());
  std::vector<std::size_t> next(first_slot_.begin(), first_slot_.end() - 1);
  for (Index column = 0; column < lower.cols(); ++column) {
    const Index k = place_[static_cast<std::size_t>(column)];
    const std::uint32_t n = node_of_[static_cast<std::size_t>(k)];
    const Supernode& node = nodes_[n];
    for (Index at = lower.outerIndexPtr()[column]; at < lower.outerIndexPtr()[column + 1]; ++at) {
      const Index row = place_[static_cast<std::size_t>(lower.innerIndexPtr()[at])];
      slots_[next[n]] = node.panel + static_cast<std::size_t>(k - node.first) * node.height() +
                        static_cast<std::size_t>(place_in(node, row));
      numbers_[next[n]++] = static_cast<std::uint32_t>(at);
    }
  }
}

bool Cholesky::eliminate(std::uint32_t n, const double* values, std::vector<MatrixXd>& updates) {
  const Supernode& node = nodes_[n];
  const auto width = static_cast<Eigen::Index>(node.width), height = static_cast<Eigen::Index>(node.height());
  Eigen::Map<MatrixXd> panel(&panels_[node.panel], height, width);
  panel.setZero();
  for (std::size_t s = first_slot_[n]; s < first_slot_[n + 1]; ++s) panels_[slots_[s]] += values[numbers_[s]];
  MatrixXd update = MatrixXd::Zero(height - width, height - width);
  for (const std::uint32_t child : node.children) {
    const MatrixXd& theirs = updates[child];
    const auto& into = nodes_[child].into_parent;
    for (Eigen::Index c = 0; c < theirs.cols(); ++c) {
      const Index column = into[static_cast<std::size_t>(c)];
      double* target = column < node.width ? &panel(0, column) : &update(0, column - width) - width;
      for (Eigen::Index r = c; r < theirs.rows(); ++r)
        target[into[static_cast<std::size_t>(r)]] += theirs(r, c);
    }
    updates[child].resize(0, 0);
  }
  if (!factorise_columns(panel.data(), height, height, width)) return false;
  if (height > width) {
    subtract_products(panel.data() + width, height, update.data(), height - width, height - width,
                      height - width, width);
    updates[n] = std::move(update);
  }
  return true;
}

bool Cholesky::factorise(const Eigen::SparseMatrix<double>& lower) {
  std::vector<MatrixXd> updates(nodes_.size());
  std::vector<std::atomic<std::size_t>> pending(nodes_.size());
  std::vector<std::uint32_t> leaves;
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    pending[n] = nodes_[n].children.size();
    if (nodes_[n].children.empty()) leaves.push_back(n);
  }
  std::atomic<bool> positive = true;
  // The thread that finishes the last child of a supernode continues with the supernode.
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t leaf) {
    for (std::int64_t n = leaves[leaf]; n >= 0 && positive;) {
      if (!eliminate(static_cast<std::uint32_t>(n), lower.valuePtr(), updates)) positive = false;
      n = nodes_[static_cast<std::size_t>(n)].parent;
      if (n >= 0 && --pending[static_cast<std::size_t>(n)] > 0) break;
    }
  });
  return positive;
}

template <int Columns>
Eigen::Matrix<double, Eigen::Dynamic, Columns> Cholesky::solve_columns(
    const Eigen::Matrix<double, Eigen::Dynamic, Columns>& right) const {
  Eigen::Matrix<double, Eigen::Dynamic, Columns> x(right.rows(), Columns), below;
  for (Eigen::Index i = 0; i < right.rows(); ++i) x.row(place_[static_cast<std::size_t>(i)]) = right.row(i);
  const auto panel_of = [&](const Supernode& node) {
    return Eigen::Map<const MatrixXd>(&panels_[node.panel], static_cast<Eigen::Index>(node.height()),
                                      node.width);
  };
  for (const Supernode& node : nodes_) {
    const auto panel = panel_of(node);
    auto own = x.middleRows(node.first, node.width);
    panel.topRows(node.width).template triangularView<Eigen::Lower>().solveInPlace(own);
    below.noalias() = panel.bottomRows(panel.rows() - node.width) * own;
    for (std::size_t r = 0; r < node.rows.size(); ++r)
      x.row(node.rows[r]) -= below.row(static_cast<Eigen::Index>(r));
  }
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) {
    const auto panel = panel_of(*node);
    below.resize(static_cast<Eigen::Index>(node->rows.size()), Columns);
    for (std::size_t r = 0; r < node->rows.size(); ++r)
      below.row(static_cast<Eigen::Index>(r)) = x.row(node->rows[r]);
    auto own = x.middleRows(node->first, node->width);
    own.noalias() -= panel.bottomRows(panel.rows() - node->width).transpose() * below;
    panel.topRows(node->width).template triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
  Eigen::Matrix<double, Eigen::Dynamic, Columns> result(right.rows(), Columns);
  for (Eigen::Index i = 0; i < right.rows(); ++i) result.row(i) = x.row(place_[static_cast<std::size_t>(i)]);
  return result;
}

template Eigen::VectorXd Cholesky::solve_columns<1>(const Eigen::VectorXd&) const;
template Eigen::MatrixX3d Cholesky::solve_columns<3>(const Eigen::MatrixX3d&) const;

}  // namespace plisse::shell
