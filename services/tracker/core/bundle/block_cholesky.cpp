// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/bundle/block_cholesky.hpp"

#include <algorithm>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace rds::tracker {

std::vector<std::uint32_t> elimination_order(const Neighbours& neighbours) {
  const auto rows = static_cast<int>(neighbours.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < rows; ++i) {
    entries.emplace_back(i, i, 1);
    for (const std::uint32_t j : neighbours[static_cast<std::size_t>(i)])
      entries.emplace_back(i, static_cast<int>(j), 1);
  }
  Eigen::SparseMatrix<double> pattern(rows, rows);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> eliminated;
  Eigen::AMDOrdering<int>()(pattern, eliminated);
  std::vector<std::uint32_t> place(neighbours.size());
  for (int i = 0; i < rows; ++i)
    place[static_cast<std::size_t>(eliminated.indices()[i])] = static_cast<std::uint32_t>(i);
  return place;
}

/// A column has the rows of its neighbours below it, and those of the columns that are eliminated before it
/// and have their next block in its row.
BlockCholesky::BlockCholesky(const Neighbours& neighbours) : begin_{0} {
  Neighbours below(neighbours.size());
  for (std::uint32_t column = 0; column < neighbours.size(); ++column) {
    auto& rows = below[column];
    std::ranges::copy_if(neighbours[column], std::back_inserter(rows),
                         [&](std::uint32_t row) { return row > column; });
    std::ranges::sort(rows);
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    rows_.push_back(column);
    rows_.insert(rows_.end(), rows.begin(), rows.end());
    begin_.push_back(rows_.size());
    if (rows.empty()) continue;
    auto& next = below[rows.front()];
    next.insert(next.end(), rows.begin() + 1, rows.end());
  }
  blocks_.assign(rows_.size(), Block::Zero());
}

void BlockCholesky::clear() {
  std::ranges::fill(blocks_, Block::Zero());
}

std::size_t BlockCholesky::index(std::uint32_t row, std::uint32_t column) const {
  const auto first = rows_.begin() + static_cast<std::ptrdiff_t>(begin_.at(column));
  const auto end = rows_.begin() + static_cast<std::ptrdiff_t>(begin_.at(column + 1));
  const auto found = std::lower_bound(first, end, row);
  if (found == end || *found != row) throw std::out_of_range("BlockCholesky: a block that is always zero");
  return static_cast<std::size_t>(found - rows_.begin());
}

bool BlockCholesky::factor() {
  for (std::size_t column = 0; column < rows(); ++column) {
    const std::size_t diagonal = begin_[column];
    const std::size_t end = begin_[column + 1];
    const Eigen::LLT<Block> llt(blocks_[diagonal]);
    if (llt.info() != Eigen::Success) return false;
    const Block factor = llt.matrixL();
    blocks_[diagonal] = factor;
    for (std::size_t i = diagonal + 1; i < end; ++i) {
      const Block transposed = blocks_[i].transpose();
      blocks_[i] = factor.triangularView<Eigen::Lower>().solve(transposed).transpose();
    }
    for (std::size_t left = diagonal + 1; left < end; ++left) {
      std::size_t target = begin_[rows_[left]];
      for (std::size_t i = left; i < end; ++i) {
        while (rows_[target] != rows_[i]) ++target;
        blocks_[target].noalias() -= blocks_[i] * blocks_[left].transpose();
      }
    }
  }
  return true;
}

void BlockCholesky::solve(std::span<Segment> x) const {
  for (std::size_t column = 0; column < rows(); ++column) {
    const std::size_t diagonal = begin_[column];
    blocks_[diagonal].triangularView<Eigen::Lower>().solveInPlace(x[column]);
    for (std::size_t i = diagonal + 1; i < begin_[column + 1]; ++i)
      x[rows_[i]].noalias() -= blocks_[i] * x[column];
  }
  for (std::size_t column = rows(); column-- > 0;) {
    const std::size_t diagonal = begin_[column];
    for (std::size_t i = diagonal + 1; i < begin_[column + 1]; ++i)
      x[column].noalias() -= blocks_[i].transpose() * x[rows_[i]];
    blocks_[diagonal].transpose().triangularView<Eigen::Upper>().solveInPlace(x[column]);
  }
}

}  // namespace rds::tracker
