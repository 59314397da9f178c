// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/services/tracker/core/tracker_scene.hpp"

namespace rds::tracker {
namespace {

using namespace test;

constexpr int kFrames = 60;  // 4 s

/// In front of the wall, turning to and fro by 0.4 rad/s at most.
Pose looking_around(double frame) {
  return pose(0.05 * std::sin(0.05 * frame), 0, 0, 0.12 * std::sin(0.22 * frame));
}

std::optional<Eigen::Quaterniond> exact(std::int64_t from_ns, std::int64_t to_ns) {
  const auto at = [](std::int64_t ns) { return looking_around(static_cast<double>(ns) / kFrameNs).linear(); };
  return Eigen::Quaterniond(at(from_ns).transpose() * at(to_ns));
}

std::optional<Eigen::Quaterniond> the_other_way(std::int64_t from_ns, std::int64_t to_ns) {
  return exact(from_ns, to_ns)->conjugate();
}

struct Tracked {
  double largest_error_m = 0;
  int frames_without_pose = 0;
  std::uint64_t told = 0;
  std::uint64_t refused = 0;
};

Tracked run_with(Gyroscope gyroscope) {
  Tracker tracker(small_config(), {.gyroscope = std::move(gyroscope)});
  Tracked run;
  for (int i = 0; i < kFrames; ++i) {
    const FrameResult result = tracker.track(picture_of_strips(looking_around(i), i * kFrameNs), {});
    const Pose expected = looking_around(0).inverse() * looking_around(i);
    if (has_pose(result.state))
      run.largest_error_m = std::max(run.largest_error_m,
                                     (expected.translation() - result.map_from_camera.translation()).norm());
    else
      ++run.frames_without_pose;
  }
  run.told = tracker.gyroscope().told();
  run.refused = tracker.gyroscope().refused();
  return run;
}

TEST(TrackerGyroscope, ExpectsTheTurnThatATrustedGyroscopeTells) {
  const Tracked run = run_with(exact);
  EXPECT_EQ(run.frames_without_pose, 0);
  EXPECT_LT(run.largest_error_m, 0.01);
  EXPECT_GT(run.told, kFrames / 3U);
  EXPECT_EQ(run.refused, 0U);
}

TEST(TrackerGyroscope, AWrongOneChangesNothing) {
  const Tracked without = run_with({});
  const Tracked wrong = run_with(the_other_way);
  EXPECT_EQ(wrong.frames_without_pose, 0);
  EXPECT_EQ(wrong.told, 0U);
  EXPECT_GT(wrong.refused, 3U);
  EXPECT_EQ(wrong.largest_error_m, without.largest_error_m) << "bit by bit";
}

TEST(TrackerGyroscope, IsPredictedWithoutMovingThePlace) {
  MotionPrediction prediction(pose(1, 2, 3, 0.5), std::nullopt, 0.05);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()));
  prediction.expect_turn(turn);
  EXPECT_TRUE(prediction.camera_from_map().inverse().isApprox(pose(1, 2, 3, 0.7), 1e-12));
}

}  // namespace
}  // namespace rds::tracker
