// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/services/tracker/core/tracker_scene.hpp"

namespace rds::tracker {
namespace {

using namespace test;

constexpr int kSeen = 100;    // frames, 6.6 s
constexpr int kCovered = 20;  // 1.3 s

/// Along the wall and back.
Pose swaying(int frame) {
  return pose(0.3 * std::sin(0.07 * frame), 0.06 * std::sin(0.05 * frame), 0.05 * std::sin(0.09 * frame));
}

image::RgbdFrame picture(int frame) {
  return picture_of_strips(swaying(frame), frame * kFrameNs);
}

/// Odometry of the camera itself, by which everything is 5 % further.
std::optional<OdometryPose> five_percent_too_far(std::int64_t stamp_ns) {
  Pose told = Pose::Identity();
  for (int i = 1; i <= stamp_ns / kFrameNs; ++i) {
    Twist step = se3_log(swaying(i - 1).inverse() * swaying(i));
    told = told * se3_exp(1.05 * step);
  }
  return OdometryPose{told, Pose::Identity(), 0};
}

std::optional<OdometryPose> frozen(std::int64_t /*stamp_ns*/) {
  return OdometryPose{};
}

Tracker tracker_with(RobotOdometry odometry) {
  return Tracker(small_config(), {.odometry = std::move(odometry)});
}

double error_of(const FrameResult& result, int frame) {
  const Pose expected = swaying(0).inverse() * swaying(frame);
  return (expected.translation() - result.map_from_camera.translation()).norm();
}

TEST(TrackerOdometry, CarriesACoveredCameraOn) {
  Tracker tracker = tracker_with(five_percent_too_far);
  for (int i = 0; i < kSeen; ++i) ASSERT_TRUE(has_pose(tracker.track(picture(i), {}).state)) << i;
  ASSERT_TRUE(tracker.odometry().is_trusted());
  EXPECT_NEAR(tracker.odometry().scale()[0], 1 / 1.05, 0.02);
  double variance = 0;
  for (int i = kSeen; i < kSeen + kCovered; ++i) {
    const FrameResult carried = tracker.track(dark_picture(i * kFrameNs), {});
    ASSERT_EQ(carried.state, State::kWeak) << i;
    EXPECT_LT(error_of(carried, i), 0.03) << i;
    EXPECT_EQ(carried.inliers, 0U);
    EXPECT_FALSE(carried.keyframe);
    ASSERT_TRUE(carried.carried_covariance);
    EXPECT_GT((*carried.carried_covariance)(0, 0), variance);
    variance = (*carried.carried_covariance)(0, 0);
    EXPECT_FALSE(tracker.has_lost_young_map(i * kFrameNs));
  }
  const FrameResult found = tracker.track(picture(kSeen + kCovered), {});
  EXPECT_EQ(found.state, State::kRelocalised);
  EXPECT_FALSE(found.carried_covariance);
  EXPECT_LT(error_of(found, kSeen + kCovered), 0.02);
}

TEST(TrackerOdometry, LeavesAnUnknownPlaceThatIsSeenToASubmap) {
  Tracker tracker = tracker_with(five_percent_too_far);
  for (int i = 0; i < kSeen; ++i) tracker.track(picture(i), {});
  for (int i = kSeen; i < kSeen + kCovered; ++i) tracker.track(dark_picture(i * kFrameNs), {});
  const int second = static_cast<int>(1'000'000'000 / kFrameNs);
  for (int i = 0; i < second + 2; ++i) {
    const std::int64_t stamp_ns = (kSeen + kCovered + i) * kFrameNs;
    const FrameResult result = tracker.track(picture_of_strips(pose(2.7, 2.4, 0), stamp_ns), {});
    if (i < second - 1) {
      EXPECT_EQ(result.state, State::kWeak) << i;
    }
    if (result.begins_submap) return;
  }
  ADD_FAILURE() << "no submap has begun";
}

TEST(TrackerOdometry, ThatIsWrongCarriesNothingOnAndDoesNoHarm) {
  Tracker with = tracker_with(frozen);
  Tracker without = tracker_with({});
  for (int i = 0; i < kSeen / 2; ++i) {
    const FrameResult a = with.track(picture(i), {});
    const FrameResult b = without.track(picture(i), {});
    ASSERT_EQ(a.state, b.state) << i;
    ASSERT_TRUE(a.map_from_camera.matrix() == b.map_from_camera.matrix()) << i;
  }
  EXPECT_EQ(with.track(dark_picture(kSeen / 2 * kFrameNs), {}).state, State::kLost);
}

TEST(TrackerOdometry, IsForgottenByAReset) {
  Tracker tracker = tracker_with(five_percent_too_far);
  for (int i = 0; i < kSeen; ++i) tracker.track(picture(i), {});
  ASSERT_TRUE(tracker.odometry().is_trusted());
  tracker.reset();
  EXPECT_FALSE(tracker.odometry().is_trusted());
  tracker.track(picture(kSeen), {});
  EXPECT_EQ(tracker.track(dark_picture((kSeen + 1) * kFrameNs), {}).state, State::kLost);
}

TEST(TrackerOdometry, OfARobotIsNotReadWherePosesAreGiven) {
  const GivenPoses given = [](std::int64_t stamp_ns) {
    return std::optional(swaying(static_cast<int>(stamp_ns / kFrameNs)));
  };
  Tracker tracker(small_config(), {.given_poses = given, .odometry = five_percent_too_far});
  for (int i = 0; i < kSeen; ++i) tracker.track(picture(i), {});
  EXPECT_FALSE(tracker.odometry().is_trusted());
}

TEST(TrackerLevel, IsByAnAccelerometerWhereThereIsOne) {
  TrackerConfig config = small_config();
  config.map_frame.level = true;
  const Eigen::Vector3d up = Eigen::Vector3d(0.1, -0.9, -0.3).normalized();
  Tracker tracker(config);
  tracker.set_up(up);
  const FrameResult first = tracker.track(picture(0), {});
  ASSERT_EQ(first.state, State::kTracking);
  EXPECT_FALSE(first.up) << "no surface was asked";
  EXPECT_TRUE((first.map_from_camera.linear() * up).isApprox(Eigen::Vector3d::UnitZ(), 1e-9));
}

TEST(TrackerSeek, IsForALostCamera) {
  Tracker tracker(small_config());
  for (int i = 0; i < 6; ++i) step(tracker, i);
  EXPECT_FALSE(tracker.seek({}));
  tracker.track(dark_picture(6 * kFrameNs), {});
  EXPECT_TRUE(tracker.seek({}));
  EXPECT_EQ(step(tracker, 7).state, State::kRelocalised);
}

}  // namespace
}  // namespace rds::tracker
