// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/adjustment/block_cholesky.hpp"

#include <algorithm>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace rds::tracker {

BlockCholesky::BlockCholesky(std::size_t size, const Couples& couples) : place_(size), columns_(size) {
  order(couples);
  fill_in(couples);
  for (Column& column : columns_) column.blocks.resize(column.rows.size());
  set_zero();
}

void BlockCholesky::set_zero() {
  for (Column& column : columns_) {
    column.diagonal.setZero();
    std::ranges::fill(column.blocks, Matrix6::Zero());
  }
}

void BlockCholesky::order(const Couples& couples) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < place_.size(); ++i)
    entries.emplace_back(static_cast<int>(i), static_cast<int>(i), 1);
  for (const auto& [row, column] : couples) {
    entries.emplace_back(static_cast<int>(row), static_cast<int>(column), 1);
    entries.emplace_back(static_cast<int>(column), static_cast<int>(row), 1);
  }
  const auto n = static_cast<int>(place_.size());
  Eigen::SparseMatrix<double> pattern(n, n);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> index_at;
  Eigen::AMDOrdering<int>()(pattern, index_at);
  for (int place = 0; place < n; ++place)
    place_[static_cast<std::size_t>(index_at.indices()[place])] = static_cast<std::size_t>(place);
}

/// The rows of a column are its own and those of the columns whose first row it is.
void BlockCholesky::fill_in(const Couples& couples) {
  for (const auto& [row, column] : couples) {
    const auto [first, second] = std::minmax(place_[row], place_[column]);
    if (first != second) columns_[first].rows.push_back(second);
  }
  for (Column& column : columns_) {
    std::vector<std::size_t>& rows = column.rows;
    std::ranges::sort(rows);
    const auto twice = std::ranges::unique(rows);
    rows.erase(twice.begin(), twice.end());
    if (rows.empty()) continue;
    std::vector<std::size_t>& inherits = columns_[rows.front()].rows;
    inherits.insert(inherits.end(), rows.begin() + 1, rows.end());
  }
}

void BlockCholesky::add(std::size_t row, std::size_t column, const Matrix6& block) {
  const std::size_t i = place_[row];
  const std::size_t j = place_[column];
  if (i == j) throw std::invalid_argument("BlockCholesky::add: a block of the diagonal");
  Column& first = columns_[std::min(i, j)];
  const auto at = std::ranges::lower_bound(first.rows, std::max(i, j)) - first.rows.begin();
  Matrix6& sum = first.blocks[static_cast<std::size_t>(at)];
  if (i > j)
    sum += block;
  else
    sum += block.transpose();
}

bool BlockCholesky::factorize() {
  for (Column& column : columns_) {
    const Eigen::LLT<Matrix6> root(column.diagonal);
    if (root.info() != Eigen::Success) return false;
    column.diagonal = root.matrixL();
    for (Matrix6& block : column.blocks)
      root.matrixU().solveInPlace<Eigen::OnTheRight>(block);
    subtract_from_later(column);
  }
  return true;
}

/// What an eliminated column leaves: A_ik −= L_i L_kᵀ for its rows i ≥ k.
void BlockCholesky::subtract_from_later(const Column& column) {
  for (std::size_t k = 0; k < column.rows.size(); ++k) {
    Column& later = columns_[column.rows[k]];
    const Matrix6 by = column.blocks[k].transpose();
    later.diagonal.noalias() -= column.blocks[k] * by;
    std::size_t at = 0;
    for (std::size_t i = k + 1; i < column.rows.size(); ++i) {
      while (later.rows[at] != column.rows[i]) ++at;
      later.blocks[at].noalias() -= column.blocks[i] * by;
    }
  }
}

void BlockCholesky::solve(std::vector<Twist>& b) const {
  std::vector<Twist> x(b.size());
  for (std::size_t i = 0; i < b.size(); ++i) x[place_[i]] = b[i];
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    const Column& column = columns_[j];
    column.diagonal.triangularView<Eigen::Lower>().solveInPlace(x[j]);
    for (std::size_t k = 0; k < column.rows.size(); ++k) x[column.rows[k]] -= column.blocks[k] * x[j];
  }
  for (std::size_t j = columns_.size(); j-- > 0;) {
    const Column& column = columns_[j];
    for (std::size_t k = 0; k < column.rows.size(); ++k)
      x[j] -= column.blocks[k].transpose() * x[column.rows[k]];
    column.diagonal.triangularView<Eigen::Lower>().transpose().solveInPlace(x[j]);
  }
  for (std::size_t i = 0; i < b.size(); ++i) b[i] = x[place_[i]];
}

std::size_t BlockCholesky::blocks() const {
  std::size_t count = 0;
  for (const Column& column : columns_) count += column.rows.size();
  return count;
}

}  // namespace rds::tracker
