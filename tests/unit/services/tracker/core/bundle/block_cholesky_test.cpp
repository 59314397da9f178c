// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/bundle/block_cholesky.hpp"

#include <algorithm>
#include <random>

#include <Eigen/Dense>
#include <gmock/gmock.h>

namespace rds::tracker {
namespace {

using Segment = BlockCholesky::Segment;

constexpr std::uint32_t kRows = 12;

/// A ring, with a chord: elimination fills it.
Neighbours ring() {
  Neighbours neighbours(kRows);
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  };
  for (std::uint32_t i = 0; i < kRows; ++i) join(i, (i + 1) % kRows);
  join(2, 7);
  return neighbours;
}

/// Random blocks where the ring has some; positive definite by its diagonal.
Eigen::MatrixXd random_matrix() {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> value(-1, 1);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(6 * kRows, 6 * kRows);
  const Neighbours neighbours = ring();
  for (std::uint32_t i = 0; i < kRows; ++i) {
    matrix.block<6, 6>(6 * i, 6 * i) = 40 * Eigen::Matrix<double, 6, 6>::Identity();
    for (const std::uint32_t j : neighbours[i])
      if (j < i) {
        const Eigen::Matrix<double, 6, 6> block =
            Eigen::Matrix<double, 6, 6>::NullaryExpr([&] { return value(random); });
        matrix.block<6, 6>(6 * i, 6 * j) = block;
        matrix.block<6, 6>(6 * j, 6 * i) = block.transpose();
      }
  }
  return matrix;
}

BlockCholesky in_blocks(const Eigen::MatrixXd& matrix) {
  BlockCholesky blocks(ring());
  const Neighbours neighbours = ring();
  for (std::uint32_t column = 0; column < kRows; ++column) {
    blocks[blocks.index(column, column)] = matrix.block<6, 6>(6 * column, 6 * column);
    for (const std::uint32_t row : neighbours[column])
      if (row > column) blocks[blocks.index(row, column)] = matrix.block<6, 6>(6 * row, 6 * column);
  }
  return blocks;
}

TEST(BlockCholesky, SolvesAsADenseMatrixDoes) {
  const Eigen::MatrixXd matrix = random_matrix();
  BlockCholesky blocks = in_blocks(matrix);
  const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(6 * kRows, -1, 2);
  const Eigen::VectorXd expected = matrix.ldlt().solve(right);
  std::vector<Segment> x(kRows);
  for (std::uint32_t i = 0; i < kRows; ++i) x[i] = right.segment<6>(6 * i);
  ASSERT_TRUE(blocks.factor());
  blocks.solve(x);
  for (std::uint32_t i = 0; i < kRows; ++i)
    EXPECT_LT((x[i] - expected.segment<6>(6 * i)).norm(), 1e-12) << i;
}

TEST(BlockCholesky, SaysWhatIsNotPositiveDefinite) {
  Eigen::MatrixXd matrix = random_matrix();
  matrix(30, 30) = -1;
  EXPECT_FALSE(in_blocks(matrix).factor());
}

TEST(BlockCholesky, RefusesABlockThatIsAlwaysZero) {
  EXPECT_THROW((void)BlockCholesky(ring()).index(4, 0), std::out_of_range);
  EXPECT_THROW((void)BlockCholesky(ring()).index(0, 1), std::out_of_range);
}

TEST(EliminationOrder, TakesEachRowOnceAndTheMiddleOfAStarLast) {
  Neighbours star(kRows);
  for (std::uint32_t i = 1; i < kRows; ++i) {
    star[0].push_back(i);
    star[i].push_back(0);
  }
  auto place = elimination_order(star);
  EXPECT_GE(place[0], kRows - 2);  // with the last leaf it is all the same
  std::ranges::sort(place);
  for (std::uint32_t i = 0; i < kRows; ++i) EXPECT_EQ(place[i], i);
}

}  // namespace
}  // namespace rds::tracker
