// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/association.hpp"

#include <gtest/gtest.h>

#include "services/tracker/core/mapping/map_building.hpp"
#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

constexpr std::size_t kStanding = 150;  // of the points, known for long; all others have just been seen first
constexpr std::size_t kPoints = 600;
constexpr std::int64_t kLongNs = 1'000'000'000;
constexpr double kMoved_m = 0.03;

class FramePose : public testing::Test {
 protected:
  FramePose() {
    add(0, kStanding);
    add(kLongNs, kPoints);
  }

  /// A keyframe at the origin that sees the first points.
  void add(std::int64_t stamp_ns, std::size_t count) {
    TrackedFrame frame = frame_of({points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count)});
    frame.stamp_ns = frame.time_ns = stamp_ns;
    const Keyframe& keyframe = insert_keyframe(map, frame, DepthConfig{});
    for (std::size_t f = 0; f < view.point.size(); ++f) known[view.point[f]] = keyframe.points[f];
  }

  TrackedFrame frame_of(const std::vector<Eigen::Vector3d>& seen) {
    TrackedFrame frame;
    view = test::view_of(seen, Pose::Identity(), 0, random);
    frame.features = view.features;
    for (const std::size_t point : view.point) frame.points.push_back(known[point]);
    return frame;
  }

  /// How far off is the pose of a still camera when all but the standing points have moved on? [m]
  double error_m(bool movable_in_view) {
    std::vector<Eigen::Vector3d> seen = points;
    for (std::size_t i = kStanding; i < kPoints; ++i) seen[i].x() += kMoved_m;
    TrackedFrame frame = frame_of(seen);
    frame.movable_in_view = movable_in_view;
    const ObservationModel model(frame.features->camera());
    optimize_frame(map, model, pyramid, frame);
    return frame.camera_from_map.translation().norm();
  }

  std::mt19937 random{4};
  std::vector<Eigen::Vector3d> points = test::random_points(kPoints, random);
  std::vector<PointId> known = std::vector<PointId>(kPoints, kNoId);
  test::SyntheticView view;
  ScalePyramid pyramid{8, 1.2};
  SlamMap map{pyramid};
};

TEST_F(FramePose, WhileSomethingMovableIsInViewPointsKnownForLongDecide) {
  EXPECT_LT(error_m(true), 0.1 * kMoved_m);
}

TEST_F(FramePose, PointsThatFramesHaveFoundForHalfASecondDecideAsWell) {
  const auto set_moved = [&](std::int64_t last_found_ns, std::uint32_t visible) {
    for (std::size_t i = kStanding; i < kPoints; ++i)
      if (MapPoint* point = map.point(known[i])) {
        point->last_found_ns = last_found_ns;
        point->visible = visible;
      }
  };
  set_moved(2 * kLongNs, 1);
  EXPECT_GT(error_m(true), 0.8 * kMoved_m);
  set_moved(2 * kLongNs, 10);  // most frames did not
  EXPECT_LT(error_m(true), 0.1 * kMoved_m);
}

TEST_F(FramePose, WithoutMovableObjectsMostPointsDecide) {
  EXPECT_GT(error_m(false), 0.8 * kMoved_m);
}

}  // namespace
}  // namespace rds::tracker
