// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "services/tracker/core/bundle/block_cholesky.hpp"
#include "services/tracker/core/bundle/sparse_bundle.hpp"

namespace rds::tracker {

/// How cameras and points are to move, and by how much the linear model says that this lowers the cost.
struct BundleStep {
  std::vector<Twist> cameras;           // by camera; 0 of fixed ones, and of those that see nothing
  std::vector<Eigen::Vector3d> points;  // by point
  double expected_gain = 0;
};

/// The normal equations of a bundle, from which the points are eliminated.
class ReducedSystem {
 public:
  explicit ReducedSystem(const SparseBundle& bundle);

  /// Of the bundle as it is. @return nullopt where λ is too small to solve it.
  std::optional<BundleStep> solve(const SparseBundle& bundle, bool is_robust, double lambda);

 private:
  void build(const SparseBundle& bundle, bool is_robust, double lambda);
  void move_points(const SparseBundle& bundle, bool is_robust, double lambda, BundleStep& step) const;

  static constexpr std::uint32_t kFixed = ~std::uint32_t{0};
  std::vector<std::uint32_t> row_;             // of each camera in the matrix; kFixed: it stays
  std::vector<std::uint32_t> pairs_;           // blocks of each point's pairs of cameras, one after the other
  BlockCholesky matrix_;
  std::vector<BlockCholesky::Segment> right_;  // −g of the cameras, points eliminated
  std::vector<BlockCholesky::Segment> gradient_;
  std::vector<BlockCholesky::Segment> diagonal_;  // of H
};

/// Half the sum of squared residuals, robust or not; infinity if a point lies behind its camera.
double cost_of(const SparseBundle& bundle, bool is_robust);

}  // namespace rds::tracker
