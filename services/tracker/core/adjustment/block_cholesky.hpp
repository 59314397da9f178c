// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "services/tracker/core/motion/se3.hpp"

namespace rds::tracker {

/// A symmetric positive definite matrix of N×N blocks of 6×6, few of them other than zero, and its Cholesky
/// factor, which takes its place.
///
/// Blocks are what keyframes share. The order of elimination, and which blocks the factor has, follow from
/// which are there alone, and are found once. No threads and no BLAS: the same bits every time.
/// Source: Davis 2006, §3–4, §7.1 (approximate minimum degree). Deviation: entries are blocks.
class BlockCholesky {
 public:
  using Couples = std::vector<std::pair<std::size_t, std::size_t>>;

  /// @param size     N. @param couples  blocks (row, column) beside the diagonal, in any order, each as often
  /// as it likes.
  BlockCholesky(std::size_t size, const Couples& couples);

  [[nodiscard]] std::size_t size() const { return columns_.size(); }
  void set_zero();
  [[nodiscard]] Matrix6& diagonal(std::size_t i) { return columns_[place_[i]].diagonal; }
  /// Adds to the blocks (row, column) and (column, row). @param block  of (row, column). The couple is known.
  void add(std::size_t row, std::size_t column, const Matrix6& block);

  /// @return false if the matrix is not positive definite.
  [[nodiscard]] bool factorize();
  /// Of the factorized matrix. @param b  N twists, replaced by the solution.
  void solve(std::vector<Twist>& b) const;

  /// Blocks of the factor beside its diagonal.
  [[nodiscard]] std::size_t blocks() const;

 private:
  struct Column {
    Matrix6 diagonal = Matrix6::Zero();
    std::vector<std::size_t> rows;  // below the diagonal, ascending
    std::vector<Matrix6> blocks;    // as rows
  };
  void order(const Couples& couples);
  void fill_in(const Couples& couples);
  void subtract_from_later(const Column& column);

  std::vector<std::size_t> place_;  // of an index in the order of elimination
  std::vector<Column> columns_;     // in that order
};

}  // namespace rds::tracker
