// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace rds::tracker {

/// Which rows of a symmetric matrix have something in common with which; both ways.
using Neighbours = std::vector<std::vector<std::uint32_t>>;

/// The order of elimination that fills few zeros (approximate minimum degree).
/// @return the place of each row.
std::vector<std::uint32_t> elimination_order(const Neighbours& neighbours);

/// A symmetric positive definite matrix of 6×6 blocks, few of which are not zero, and its Cholesky factor.
/// Rows are eliminated in their order. Single-threaded: the same bits every time.
class BlockCholesky {
 public:
  using Block = Eigen::Matrix<double, 6, 6>;
  using Segment = Eigen::Matrix<double, 6, 1>;

  /// All zero.
  explicit BlockCholesky(const Neighbours& neighbours);
  void clear();

  [[nodiscard]] std::size_t rows() const { return begin_.size() - 1; }
  /// Where a block is that may be other than zero. @param row  not above the diagonal.
  /// @throws std::out_of_range for any other.
  [[nodiscard]] std::size_t index(std::uint32_t row, std::uint32_t column) const;
  /// On and below the diagonal.
  Block& operator[](std::size_t index) { return blocks_[index]; }

  /// Puts the factor in the matrix's place. @return false if the matrix is not positive definite: then its
  /// blocks mean nothing.
  [[nodiscard]] bool factor();
  /// After factor(). @param x  the right-hand side, then the solution.
  void solve(std::span<Segment> x) const;

 private:
  std::vector<std::size_t> begin_;   // of each column's blocks; the first one is on the diagonal
  std::vector<std::uint32_t> rows_;  // of each block, ascending in a column
  std::vector<Block> blocks_;
};

}  // namespace rds::tracker
