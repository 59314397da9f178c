// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/markov_field.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace rds::segmentation {
namespace {

Couplings equal(const cv::Size& size, float coupling) {
  return {cv::Mat1f(size, coupling), cv::Mat1f(size, coupling)};
}

TEST(MarkovField, CellsWithoutNeighboursKeepTheirOwn) {
  const cv::Mat1f own = (cv::Mat1f(2, 3) << 1, -2, 3, -4, 5, -6);
  EXPECT_EQ(cv::norm(propagate(own, equal(own.size(), 0)), own), 0);
}

/// How much likelier the best labelling with cell 1 is than the best without, of a row: all are tried.
float best_difference(const cv::Mat1f& own, const cv::Mat1f& couplings, int cell) {
  float best[2] = {-1e9F, -1e9F};
  const int count = own.cols;
  for (unsigned labels = 0; labels < 1U << static_cast<unsigned>(count); ++labels) {
    const auto label = [&](int i) { return labels >> static_cast<unsigned>(i) & 1U; };
    float score = 0;
    for (int i = 0; i < count; ++i) {
      if (label(i) == 1) score += own(0, i);
      if (i > 0 && label(i) != label(i - 1)) score -= couplings(0, i - 1);
    }
    best[label(cell)] = std::max(best[label(cell)], score);
  }
  return best[1] - best[0];
}

TEST(MarkovField, IsExactAlongARow) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> value(-4, 4);
  for (int trial = 0; trial < 20; ++trial) {
    cv::Mat1f own(1, 8);
    Couplings couplings = equal(own.size(), 0);
    for (int i = 0; i < own.cols; ++i) {
      own(0, i) = value(random);
      couplings.right(0, i) = std::abs(value(random));
    }
    const cv::Mat1f found = propagate(own, couplings);
    for (int i = 0; i < own.cols; ++i)
      EXPECT_NEAR(found(0, i), best_difference(own, couplings.right, i), 1e-4) << trial << ' ' << i;
  }
}

TEST(MarkovField, AThingTakesItsUndecidedCellsAlongAndEndsAtAStep) {
  cv::Mat1f own(9, 9, -1.0F);
  own(cv::Rect(0, 0, 5, 9)) = -0.2F;
  own(cv::Rect(0, 0, 2, 9)) = 3;
  Couplings couplings = equal(own.size(), 2);
  couplings.right.col(4) = 0;
  const cv::Mat1f found = propagate(own, couplings);
  EXPECT_GT(found(4, 4), 0) << "as its neighbours are";
  EXPECT_LT(found(4, 5), 0) << "beyond the step";
}

}  // namespace
}  // namespace rds::segmentation
