// SPDX-License-Identifier: Apache-2.0
// Does odometry tell how wrong it is? The tracker core alone, on rendered recordings, whose truth is exact.
#include "tests/support/odometry_consistency.hpp"

#include <string>

#include <gtest/gtest.h>

#include "tests/support/shared_data.hpp"
#include "tests/support/tracker_sequence.hpp"

namespace rds::test {
namespace {

// The mean of six degrees of freedom is 6; over many runs it is 3.5, as the covariance is a bound
// (docs/decisions/odometry-covariance.md). One run's mean is that of errors that depend on each other, so its
// bounds are those of one χ², 2.5 % and 97.5 %, the lower one of a covariance that is twice too large.
constexpr double kLeastNees = 1.24 / 2;
constexpr double kMostNees = 14.45;
constexpr double kMaxTurnRadPerS = 1.0 / 57.2958;

struct Bounds {
  std::size_t frames;
  double speed_m_per_s;
};

void expect_consistent(const std::string& recording, const Bounds& bounds) {
  cv::setNumThreads(1);
  const auto dataset = image::TumDataset::open(rendered_recording(recording));
  ASSERT_TRUE(dataset) << dataset.error();
  const auto truth = dataset->ground_truth().value();
  ASSERT_GE(dataset->frames().size(), bounds.frames);
  TrackerSequence sequence({}, *dataset, {});
  OdometryConsistency consistency(truth);
  for (std::size_t i = 0; i < bounds.frames; ++i)
    consistency.add(dataset->frames()[i].stamp_ns, sequence.step(i));
  const auto& errors = consistency.errors();
  EXPECT_EQ(errors.size(), bounds.frames - 1) << "the first defines the frame";
  const double nees = mean_of(errors, &OdometryError::nees);
  EXPECT_GT(nees, kLeastNees);
  EXPECT_LT(nees, kMostNees);
  EXPECT_LT(median_of(errors, &OdometryError::speed_m_per_s), bounds.speed_m_per_s);
  EXPECT_LT(median_of(errors, &OdometryError::turn_rad_per_s), kMaxTurnRadPerS);
}

TEST(OdometryConsistency, OfAHandThatStaysInOnePlace) {
  expect_consistent("room_empty", {.frames = 300, .speed_m_per_s = 0.035});
}

TEST(OdometryConsistency, OfAWayAroundARoom) {
  expect_consistent("loop", {.frames = 300, .speed_m_per_s = 0.03});
}

TEST(OdometryConsistency, OfARobot) {
  expect_consistent("floor", {.frames = 240, .speed_m_per_s = 0.02});
}

}  // namespace
}  // namespace rds::test
