// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "services/tracker/core/calibration/depth_timing.hpp"

namespace rds::tracker {
namespace {

using geometry::CameraModel;
using geometry::Pose;

constexpr int kEnough = 15;         // pictures
constexpr double kWallM = 2.5;
constexpr double kBoardsM = 1;
constexpr double kTurnRate = 1.2;   // rad/s

CameraModel camera() {
  return {.width = 640, .height = 480, .fx = 525, .fy = 525, .cx = 319.5, .cy = 239.5, .distortion = {}};
}

/// White boards in front of a grey wall, as a camera sees them that has turned by `turned` (rad, a vector).
bool is_board(const Eigen::Vector3d& turned, int x, int y) {
  const Eigen::Vector3d ray = Eigen::AngleAxisd(turned.norm(), turned.normalized()) * camera().ray({x, y});
  const Eigen::Vector2d at = ray.head<2>() / ray.z() * 6;
  return std::cos(3 * at.x()) * std::cos(2.5 * at.y()) > 0.4;
}

/// A camera that turns about an axis in the picture's plane; depth is taken `after_s` later than colour.
struct Turning {
  Eigen::Vector3d rate;  // rad/s, of the camera
  double after_s = 0;

  [[nodiscard]] ImagePyramid grey(double t) const {
    cv::Mat1b values(camera().height, camera().width);
    for (int y = 0; y < values.rows; ++y)
      for (int x = 0; x < values.cols; ++x) values(y, x) = is_board(rate * t, x, y) ? 200 : 60;
    return {values, 2};
  }
  [[nodiscard]] image::DepthImage depth(double t) const {
    cv::Mat1w values(camera().height, camera().width);
    for (int y = 0; y < values.rows; ++y)
      for (int x = 0; x < values.cols; ++x)
        values(y, x) = static_cast<std::uint16_t>(
            1000 * (is_board(rate * (t + after_s), x, y) ? kBoardsM : kWallM));
    return {values, 0.001F, nullptr};
  }
  /// camera_from_map moves by exp(velocity · dt): the other way round than the camera.
  [[nodiscard]] Twist velocity() const {
    Twist v = Twist::Zero();
    v.tail<3>() = -rate;
    return v;
  }
};

/// Directions that a hand turns a camera in.
Turning turning(int i, double after_s, double turn_rate = kTurnRate) {
  const double angle = 0.9 * i;
  return {turn_rate * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0), after_s};
}

DepthTiming learned(double after_s, double stamped_s, double turn_rate = kTurnRate, bool learns = true) {
  DepthTiming timing(learns);
  for (int i = 0; i < kEnough; ++i) {
    const Turning camera_turns = turning(i, after_s, turn_rate);
    const double t = 0.02 * i;
    timing.observe({.stamp_ns = i * 150'000'000LL,
                    .color = {},
                    .depth = camera_turns.depth(t),
                    .camera = camera(),
                    .depth_offset_ns = std::llround(stamped_s * 1e9)},
                   camera_turns.grey(t), camera_turns.velocity());
  }
  return timing;
}

TEST(DepthDelay, IsFoundFromEdges) {
  EXPECT_NEAR(learned(-0.02, 0).delay_s(), -0.02, 0.003);
  EXPECT_NEAR(learned(0.033, 0).delay_s(), 0.033, 0.003);
}

TEST(DepthDelay, IsBesideWhatTheStampsSay) {
  EXPECT_EQ(learned(0.012, 0.012).delay_s(), 0) << "the stamps are right";
  EXPECT_NEAR(learned(-0.008, 0.012).delay_s(), -0.02, 0.003);
}

TEST(DepthDelay, IsNotKnownOfACameraThatHardlyTurns) {
  EXPECT_EQ(learned(-0.02, 0, 0.1).delay_s(), 0);
}

TEST(DepthDelay, IsNotLearnedWhereASettingSaysSo) {
  EXPECT_EQ(learned(-0.02, 0, kTurnRate, false).delay_s(), 0);
}

TEST(DepthTiming, MovesDepthToColoursTime) {
  const Turning turns = turning(3, 0.015);
  image::RgbdFrame frame{.stamp_ns = 0, .color = {}, .depth = turns.depth(0.1), .camera = camera()};
  const image::DepthImage expected = turns.depth(0.1 - turns.after_s);
  const auto wrong = [&](const DepthTiming& timing) {
    DepthTiming mine = timing;
    const cv::Mat moved = mine.at_color_time(frame, turns.velocity(), execute_serially).values;
    cv::Mat differs;
    cv::absdiff(moved, expected.values, differs);
    return cv::countNonZero((differs > 100) & (moved > 0));
  };
  const int as_taken = wrong(DepthTiming(true));
  frame.depth_offset_ns = 15'000'000;
  EXPECT_LT(10 * wrong(DepthTiming(true)), as_taken);
  EXPECT_GT(as_taken, 3000);
}

}  // namespace
}  // namespace rds::tracker
