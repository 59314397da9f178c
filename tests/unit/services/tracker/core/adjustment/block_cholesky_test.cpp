// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/adjustment/block_cholesky.hpp"

#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace rds::tracker {
namespace {

constexpr std::size_t kSize = 12;

/// A ring with a chord, as keyframes around a floor share points, and the same matrix with all its zeros.
struct Ring {
  explicit Ring(double diagonal)
      : sparse(kSize, couples()), dense(Eigen::MatrixXd::Zero(6 * kSize, 6 * kSize)) {
    std::mt19937 random{3};
    std::uniform_real_distribution<double> value(-1, 1);
    for (std::size_t i = 0; i < kSize; ++i) {
      sparse.diagonal(i) = diagonal * Matrix6::Identity();
      block(i, i) = sparse.diagonal(i);
    }
    for (const auto& [row, column] : couples()) {
      const Matrix6 shared = Matrix6::NullaryExpr([&] { return value(random); });
      sparse.add(row, column, shared);
      block(row, column) += shared;
      block(column, row) += shared.transpose();
    }
  }
  static BlockCholesky::Couples couples() {
    BlockCholesky::Couples all;
    for (std::size_t i = 0; i < kSize; ++i) all.emplace_back(i, (i + 1) % kSize);
    all.emplace_back(7, 2);
    all.emplace_back(7, 2);
    return all;
  }
  Eigen::Block<Eigen::MatrixXd, 6, 6> block(std::size_t row, std::size_t column) {
    return dense.block<6, 6>(static_cast<int>(6 * row), static_cast<int>(6 * column));
  }

  BlockCholesky sparse;
  Eigen::MatrixXd dense;
};

TEST(BlockCholesky, SolvesAsADenseFactorDoes) {
  Ring ring(20);
  std::vector<Twist> b(kSize);
  Eigen::VectorXd right(6 * kSize);
  for (std::size_t i = 0; i < kSize; ++i) {
    b[i] = Twist::LinSpaced(static_cast<double>(i), 2);
    right.segment<6>(static_cast<int>(6 * i)) = b[i];
  }
  ASSERT_TRUE(ring.sparse.factorize());
  ring.sparse.solve(b);
  const Eigen::VectorXd expected = ring.dense.llt().solve(right);
  for (std::size_t i = 0; i < kSize; ++i)
    EXPECT_TRUE(b[i].isApprox(expected.segment<6>(static_cast<int>(6 * i)), 1e-9)) << i;
}

TEST(BlockCholesky, FillsInFewBlocksOfARing) {
  EXPECT_LT(Ring(20).sparse.blocks(), 3 * kSize);  // all: kSize · (kSize − 1) / 2
}

TEST(BlockCholesky, SaysThatAMatrixIsNotPositiveDefinite) {
  EXPECT_FALSE(Ring(0.1).sparse.factorize());
}

}  // namespace
}  // namespace rds::tracker
