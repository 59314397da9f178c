// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/sort/assignment.hpp"

#include <limits>
#include <stdexcept>

namespace rds::tracker::prediction {
namespace {

using Index = Eigen::Index;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Index kNone = -1;

/// Solves for at most as many rows as columns, one augmenting path per row.
class AugmentingPaths {
 public:
  explicit AugmentingPaths(const Eigen::MatrixXd& cost)
      : cost_(cost),
        row_price_(Eigen::VectorXd::Zero(cost.rows())),
        column_price_(Eigen::VectorXd::Zero(cost.cols())),
        row_of_(static_cast<std::size_t>(cost.cols()), kNone) {
    for (Index row = 0; row < cost.rows(); ++row) augment(row);
  }

  [[nodiscard]] const std::vector<Index>& row_of_column() const { return row_of_; }

 private:
  /// Dijkstra over the columns, in reduced costs, from an unassigned row to an unassigned column.
  void augment(Index start) {
    const Index columns = cost_.cols();
    distance_.assign(static_cast<std::size_t>(columns), kInfinity);
    previous_.assign(static_cast<std::size_t>(columns), kNone);
    done_.assign(static_cast<std::size_t>(columns), false);
    Index row = start;
    Index reached = kNone;
    double length = 0;
    do {
      relax(row, reached, length);
      reached = nearest();
      length = distance_[at(reached)];
      done_[at(reached)] = true;
      row = row_of_[at(reached)];
    } while (row != kNone);
    update_prices(start, length);
    flip(start, reached);
  }

  void relax(Index row, Index through, double length) {
    for (Index j = 0; j < cost_.cols(); ++j) {
      const double via = length + cost_(row, j) - row_price_(row) - column_price_(j);
      if (done_[at(j)] || via >= distance_[at(j)]) continue;
      distance_[at(j)] = via;
      previous_[at(j)] = through;
    }
  }

  [[nodiscard]] Index nearest() const {
    Index best = kNone;
    for (Index j = 0; j < cost_.cols(); ++j)
      if (!done_[at(j)] && (best == kNone || distance_[at(j)] < distance_[at(best)])) best = j;
    return best;
  }

  void update_prices(Index start, double length) {
    row_price_(start) += length;
    for (Index j = 0; j < cost_.cols(); ++j) {
      if (!done_[at(j)]) continue;
      const double slack = length - distance_[at(j)];
      column_price_(j) -= slack;
      if (row_of_[at(j)] != kNone) row_price_(row_of_[at(j)]) += slack;
    }
  }

  void flip(Index start, Index column) {
    while (column != kNone) {
      const Index before = previous_[at(column)];
      row_of_[at(column)] = before == kNone ? start : row_of_[at(before)];
      column = before;
    }
  }

  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  const Eigen::MatrixXd& cost_;
  Eigen::VectorXd row_price_;
  Eigen::VectorXd column_price_;
  std::vector<Index> row_of_;
  std::vector<double> distance_;
  std::vector<Index> previous_;  // the column before this one on the shortest path
  std::vector<bool> done_;
};

}  // namespace

std::vector<std::optional<Index>> assign(const Eigen::MatrixXd& cost) {
  if (!cost.allFinite()) throw std::invalid_argument("assign: every cost must be finite");
  std::vector<std::optional<Index>> column_of(static_cast<std::size_t>(cost.rows()));
  if (cost.size() == 0) return column_of;
  const bool transposed = cost.rows() > cost.cols();
  const Eigen::MatrixXd wide = transposed ? Eigen::MatrixXd(cost.transpose()) : cost;
  const AugmentingPaths solution(wide);
  for (Index j = 0; j < wide.cols(); ++j) {
    const Index i = solution.row_of_column()[static_cast<std::size_t>(j)];
    if (i == kNone) continue;
    if (transposed)
      column_of[static_cast<std::size_t>(j)] = i;
    else
      column_of[static_cast<std::size_t>(i)] = j;
  }
  return column_of;
}

}  // namespace rds::tracker::prediction
