// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/depth_aligner.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "services/tracker/core/motion/se3.hpp"
#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

constexpr double kThing_m = 0.3;  // half a side of the cube

/// Depth of a corner of a room, with a cube of 0.6 m somewhere in it, from where the camera is.
class DepthAlignment : public testing::Test {
 protected:
  [[nodiscard]] double depth_m(const Eigen::Vector3d& ray, const Pose& map_from_camera,
                               const Eigen::Vector3d& thing) const {
    const Eigen::Vector3d from = map_from_camera.translation();
    const Eigen::Vector3d along = map_from_camera.linear() * ray;
    double nearest = 20;
    for (int axis = 0; axis < 3; ++axis)
      for (const double wall : {-walls_m[axis], walls_m[axis]})
        if (const double z = (wall - from[axis]) / along[axis]; z > 0) nearest = std::min(nearest, z);
    double enter = 0;
    double leave = nearest;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (thing[axis] - kThing_m - from[axis]) / along[axis];
      const double b = (thing[axis] + kThing_m - from[axis]) / along[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter < leave ? enter : nearest;
  }
  [[nodiscard]] cv::Mat1f look(const Pose& map_from_camera, const Eigen::Vector3d& thing) const {
    cv::Mat1f cells(grid.size());
    for (int r = 0; r < cells.rows; ++r)
      for (int c = 0; c < cells.cols; ++c)
        cells(r, c) = static_cast<float>(depth_m(grid.ray(c, r).cast<double>(), map_from_camera, thing));
    return cells;
  }
  [[nodiscard]] EarlierView seen(const cv::Mat1f& depth_m, const cv::Mat1b& movable) const {
    cv::Mat1b standing;
    cv::compare(movable, 0, standing, cv::CMP_EQ);
    return {{depth_m, movable, grid, Pose::Identity()}, {depth_m, standing, grid, Pose::Identity()}};
  }
  [[nodiscard]] EarlierView seen_empty() const {
    const cv::Mat1f before = look(Pose::Identity(), far_away);
    return seen(before, cv::Mat1b(before.size(), std::uint8_t{0}));
  }
  void expect_near(const std::optional<Pose>& camera_from_map, double metres, double radians) const {
    ASSERT_TRUE(camera_from_map);
    const Twist error = se3_log(*camera_from_map * moved);
    EXPECT_LT(error.head<3>().norm(), metres) << error.transpose();
    EXPECT_LT(error.tail<3>().norm(), radians);
  }

  segmentation::GridGeometry grid{test::small_camera()};
  Eigen::Vector3d walls_m{0.8, 0.6, 2.0};  // left and right, floor and ceiling, before and behind
  Eigen::Vector3d far_away{0, 0, -1.6};
  Pose moved = se3_exp((Twist() << 0.06, -0.02, 0.05, 0.02, 0.06, -0.03).finished());
  /// As the camera's motion lets one expect.
  Pose guess = se3_exp((Twist() << 0.015, -0.01, 0.01, 0.01, -0.015, 0.01).finished()) * moved.inverse();
};

TEST_F(DepthAlignment, FindsHowTheCameraMoved) {
  expect_near(align_depth(seen_empty(), look(moved, far_away), grid, guess), 0.004, 0.003);
}

TEST_F(DepthAlignment, IsNotMovedByWhatMoves) {
  const Eigen::Vector3d there(0.1, 0.4, 1.6);
  const cv::Mat1f before = look(Pose::Identity(), there);
  cv::Mat1b movable;
  cv::compare(before, look(Pose::Identity(), far_away) - 0.01F, movable, cv::CMP_LT);
  ASSERT_GT(cv::countNonZero(movable), static_cast<int>(movable.total()) / 10) << "it is large";
  const cv::Mat1f now = look(moved, there + Eigen::Vector3d(0.03, 0, 0.03));
  expect_near(align_depth(seen(before, movable), now, grid, guess), 0.008, 0.004);
}

TEST_F(DepthAlignment, SaysNothingWhereTheCameraCouldSlide) {
  walls_m = {40, 40, 2.5};  // one wall shows
  const EarlierView before = seen_empty();
  EXPECT_FALSE(align_depth(before, look(moved, far_away), grid, Pose::Identity()));
  walls_m = {40, 0.6, 2.0};  // a corridor seen from the side
  EXPECT_FALSE(align_depth(seen_empty(), look(moved, far_away), grid, Pose::Identity()));
}

TEST_F(DepthAlignment, SaysNothingOfAnotherPlace) {
  const EarlierView before = seen_empty();
  walls_m = {0.4, 0.3, 1.0};
  EXPECT_FALSE(align_depth(before, look(moved, far_away), grid, Pose::Identity()));
  EXPECT_FALSE(align_depth(before, cv::Mat1f(grid.size(), 0.0F), grid, Pose::Identity()));
}

TEST_F(DepthAlignment, ThePictureBeforeIsThatOfTheLastPose) {
  DepthAligner aligner;
  const DepthView before{&grid, look(Pose::Identity(), far_away), {}};
  const DepthView now{&grid, look(moved, far_away), {}};
  EXPECT_FALSE(aligner.estimate(now, guess)) << "there is none yet";
  aligner.set_previous(before, Pose::Identity());
  expect_near(aligner.estimate(now, guess), 0.004, 0.003);
  const Pose map_from_before = test::pose(3, 2, 1, 0.5);
  aligner.set_previous(before, map_from_before);
  const auto elsewhere = aligner.estimate(now, guess * map_from_before.inverse());
  ASSERT_TRUE(elsewhere);
  expect_near(*elsewhere * map_from_before, 0.004, 0.003);
  aligner.forget();
  EXPECT_FALSE(aligner.estimate(now, guess));
}

TEST_F(DepthAlignment, APictureOfAnotherCameraSaysNothing) {
  DepthAligner aligner;
  geometry::CameraModel other = test::small_camera();
  other.fx *= 1.1;
  const segmentation::GridGeometry other_grid(other);
  aligner.set_previous({&other_grid, cv::Mat1f(other_grid.size(), 2.0F), {}}, Pose::Identity());
  EXPECT_FALSE(aligner.estimate({&grid, look(moved, far_away), {}}, guess));
}

}  // namespace
}  // namespace rds::tracker
