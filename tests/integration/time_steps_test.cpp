// SPDX-License-Identifier: Apache-2.0
// Real services beside a camera whose stamps jump: a clock that was set, one frame far ahead, a recording that
// is played again and again with its own stamps.
#include <gmock/gmock.h>

#include "tests/integration/robot.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_domain.hpp"

namespace rds::test {
namespace {

const int kDomain = test_domain();
constexpr std::size_t kFrames = 150;
constexpr std::int64_t kSecond = 1'000'000'000;

bool has_pose(const TrackingState& state) {
  return state.state() == 1 || state.state() == 2 || state.state() == 4;
}

/// Share of the voxels that are occupied in the other map, too, or next to one that is.
double recall(const std::vector<octomap::OcTreeKey>& expected, const std::vector<octomap::OcTreeKey>& found) {
  const octomap::KeySet there(found.begin(), found.end());
  const auto is_found = [&](const octomap::OcTreeKey& key) {
    for (int i = 0; i < 27; ++i) {
      const auto beside = [&](unsigned axis, int by) { return static_cast<octomap::key_type>(key[axis] + by); };
      if (there.count({beside(0, i % 3 - 1), beside(1, i / 3 % 3 - 1), beside(2, i / 9 - 1)}) > 0) return true;
    }
    return false;
  };
  return static_cast<double>(std::ranges::count_if(expected, is_found)) / static_cast<double>(expected.size());
}

class TimeSteps : public testing::Test {
 protected:
  void SetUp() override {
    RDS_REQUIRE_SHARED("data/7scenes_kitchen");
    make_excerpt(shared() / "data/7scenes_kitchen", place / "data", kFrames);
  }
  std::vector<octomap::OcTreeKey> undisturbed() {
    Robot robot(place / "data", kDomain);
    for (std::size_t i = 0; i < kFrames; ++i) robot.show(i, robot.stamp_ns(i));
    return robot.occupied();
  }
  TemporaryFolder place;
};

TEST_F(TimeSteps, KeyframesGoOnWhereTheClockIsSetBack) {
  const auto expected = undisturbed();
  Robot robot(place / "data", kDomain);
  const std::size_t step = kFrames / 2;
  for (std::size_t i = 0; i < step; ++i) robot.show(i, robot.stamp_ns(i));
  std::size_t tracked = 0;
  std::size_t keyframes_in_a_second = 0;
  for (std::size_t i = step; i < kFrames; ++i) {
    const TrackingState state = robot.show(i, robot.stamp_ns(i) - 1000 * kSecond);
    tracked += has_pose(state) ? 1 : 0;
    const bool soon = robot.stamp_ns(i) <= robot.stamp_ns(step) + kSecond;
    keyframes_in_a_second += soon && state.is_keyframe() ? 1 : 0;
  }
  EXPECT_GE(keyframes_in_a_second, 1U);
  EXPECT_GE(tracked, kFrames - step - 3);
  EXPECT_GT(robot.predicted(), 0U);
  const double found = recall(expected, robot.occupied());
  EXPECT_GE(found, 0.95);
  EXPECT_EQ(robot.keyframes_in_map(), robot.keyframes());
  EXPECT_EQ(robot.figure("time breaks"), "1");
  EXPECT_THAT(robot.log(), testing::HasSubstr("the camera's stamps go on -999."));
}

TEST_F(TimeSteps, OneFrameFarAheadIsDroppedAndCounted) {
  const auto expected = undisturbed();
  Robot robot(place / "data", kDomain);
  const std::size_t ahead = kFrames / 2;
  std::size_t lost = 0;
  std::size_t keyframes_in_a_second = 0;
  for (std::size_t i = 0; i < kFrames; ++i) {
    const TrackingState state = robot.show(i, robot.stamp_ns(i) + (i == ahead ? 1000 * kSecond : 0));
    lost += has_pose(state) ? 0 : 1;
    EXPECT_FALSE(i == ahead && (has_pose(state) || state.is_keyframe()));
    const bool soon = i > ahead && robot.stamp_ns(i) <= robot.stamp_ns(ahead) + kSecond;
    keyframes_in_a_second += soon && state.is_keyframe() ? 1 : 0;
  }
  EXPECT_GE(keyframes_in_a_second, 1U);
  EXPECT_EQ(lost, 1U);
  EXPECT_GT(robot.predicted(), 0U);
  EXPECT_GE(recall(expected, robot.occupied()), 0.95);
  EXPECT_EQ(robot.figure("frames out of time"), "1");
  EXPECT_EQ(robot.figure("time breaks"), "");
}

TEST_F(TimeSteps, ARecordingInALoopIsTrackedAndMappedInEachLap) {
  Robot robot(place / "data", kDomain);
  for (int lap = 0; lap < 3; ++lap) {
    const std::size_t keyframes_before = robot.keyframes();
    std::size_t tracked = 0;
    std::size_t keyframes_in_a_second = 0;
    for (std::size_t i = 0; i < kFrames; ++i) {
      const TrackingState state = robot.show(i, robot.stamp_ns(i));
      tracked += has_pose(state) ? 1 : 0;
      const bool soon = robot.stamp_ns(i) <= robot.stamp_ns(0) + kSecond;
      keyframes_in_a_second += soon && state.is_keyframe() ? 1 : 0;
    }
    EXPECT_GE(tracked, kFrames - 3) << lap;
    EXPECT_GE(keyframes_in_a_second, 1U) << lap;
    EXPECT_GE(robot.keyframes(), keyframes_before + 4) << lap;
    EXPECT_GT(robot.predicted(), 0U) << lap;
  }
  EXPECT_FALSE(robot.occupied().empty());
  EXPECT_EQ(robot.keyframes_in_map(), robot.keyframes());
  EXPECT_EQ(robot.figure("time breaks"), "2");
}

}  // namespace
}  // namespace rds::test
