// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/sort/assignment.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include <gmock/gmock.h>

namespace rds::tracker::prediction {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

double total(const Eigen::MatrixXd& cost, const std::vector<std::optional<Eigen::Index>>& columns) {
  double sum = 0;
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i]) sum += cost(static_cast<Eigen::Index>(i), *columns[i]);
  return sum;
}

/// Smallest sum over all ways to give each row (of a matrix that is not taller than wide) a column of its
/// own.
double best_by_trying_all(const Eigen::MatrixXd& cost) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(cost.cols()));
  std::iota(order.begin(), order.end(), 0);
  double best = std::numeric_limits<double>::infinity();
  do {
    double sum = 0;
    for (Eigen::Index i = 0; i < cost.rows(); ++i) sum += cost(i, order[static_cast<std::size_t>(i)]);
    best = std::min(best, sum);
  } while (std::ranges::next_permutation(order).found);
  return best;
}

TEST(Assignment, PrefersTheSmallestSumToTheSmallestSingleCost) {
  const Eigen::MatrixXd cost = (Eigen::Matrix2d() << 1, 2, 2, 9).finished();
  EXPECT_THAT(assign(cost), ElementsAre(1, 0));
}

TEST(Assignment, LeavesTheDearestRowsOfATallMatrixOver) {
  const Eigen::MatrixXd cost = (Eigen::Matrix<double, 3, 1>() << 3, -1, 2).finished();
  EXPECT_THAT(assign(cost), ElementsAre(std::nullopt, 0, std::nullopt));
}

TEST(Assignment, OfAnEmptyMatrixGivesNobodyAColumn) {
  EXPECT_THAT(assign(Eigen::MatrixXd(0, 3)), IsEmpty());
  EXPECT_THAT(assign(Eigen::MatrixXd(2, 0)), ElementsAre(std::nullopt, std::nullopt));
}

TEST(Assignment, RejectsCostsThatAreNotFinite) {
  EXPECT_THROW(assign(Eigen::MatrixXd::Constant(2, 2, std::numeric_limits<double>::quiet_NaN())),
               std::invalid_argument);
}

TEST(Assignment, IsOptimalForRandomMatricesOfAllShapes) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (Eigen::Index rows = 1; rows <= 6; ++rows)
    for (Eigen::Index columns = 1; columns <= 6; ++columns) {
      Eigen::MatrixXd cost(rows, columns);
      for (double& c : cost.reshaped()) c = uniform(random);
      const auto assigned = assign(cost);
      std::set<Eigen::Index> used;
      for (const auto& column : assigned) {
        if (!column) continue;
        EXPECT_TRUE(used.insert(*column).second) << "a column was given twice";
      }
      EXPECT_EQ(static_cast<Eigen::Index>(used.size()), std::min(rows, columns));
      const Eigen::MatrixXd wide = rows > columns ? Eigen::MatrixXd(cost.transpose()) : cost;
      EXPECT_NEAR(total(cost, assigned), best_by_trying_all(wide), 1e-12);
    }
}

}  // namespace
}  // namespace rds::tracker::prediction
