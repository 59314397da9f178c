// SPDX-License-Identifier: Apache-2.0
// What stood for long is carried away, what was not there is put there: how many keyframes until the map says
// so? The camera moves, so that edges and sides are seen at changing angles.
#include <memory>

#include <gtest/gtest.h>

#include "common/geometry/box.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using geometry::Box3;

constexpr double kWallM = 3.2;
const Box3 kBox{{-0.32, -0.31, 1.82}, {0.33, 0.34, 2.36}};

/// Depth [m] at which a ray (x, y, 1) from a point meets a box; infinity if it does not.
double depth_of(const Box3& box, const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
  double near = 0;
  double far = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.min[axis] - from[axis]) / ray[axis];
    const double b = (box.max[axis] - from[axis]) / ray[axis];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near <= far ? near : std::numeric_limits<double>::infinity();
}

/// A room with a wall, and perhaps the box, ten minutes long.
class Room {
 public:
  static constexpr int kLong = 24;  // keyframes, one in 25 seconds

  void see(bool with_box, int times) {
    for (int i = 0; i < times; ++i, ++keyframes_) mapper_->integrate(keyframe(with_box));
  }
  /// The map is saved, and gone on in on another day.
  void come_back() {
    mapper_->settle({});
    const auto bytes = test::saved_bytes(*mapper_);
    mapper_ = std::make_unique<SemanticMapper>(MapperConfig{});
    if (const auto read = test::start_from(*mapper_, bytes); !read) throw std::runtime_error(read.error());
  }
  /// Occupied voxels in and around the box.
  [[nodiscard]] int voxels_of_box() const {
    return test::occupied_between(mapper_->map().tree(), kBox.min.z() - 0.1, kBox.max.z() + 0.1);
  }
  [[nodiscard]] int voxels_of_wall() const {
    return test::occupied_between(mapper_->map().tree(), kWallM - 0.1, kWallM + 0.1);
  }

 private:
  [[nodiscard]] KeyframeInput keyframe(bool with_box) const {
    const double phase = 0.7 * keyframes_;
    geometry::Pose pose(Eigen::AngleAxisd(0.1 * std::sin(1.3 * phase), Eigen::Vector3d::UnitY()));
    pose.translation() = Eigen::Vector3d(0.25 * std::sin(phase), 0.15 * std::cos(2.1 * phase), 0);
    KeyframeInput input =
        test::SyntheticKeyframe(250U * static_cast<unsigned>(keyframes_)).looked_for_objects().pose(pose);
    const Box3 wall{{-10, -10, kWallM}, {10, 10, kWallM + 1}};
    for (int row = 0; row < input.depth.values.rows; ++row)
      for (int column = 0; column < input.depth.values.cols; ++column) {
        const Eigen::Vector3d ray = pose.linear() * input.camera.ray({1.0 * column, 1.0 * row});
        const double behind = depth_of(wall, pose.translation(), ray);
        const double before = with_box ? depth_of(kBox, pose.translation(), ray) : behind;
        input.depth.values.at<float>(row, column) = static_cast<float>(std::min(behind, before));
      }
    return input;
  }

  std::unique_ptr<SemanticMapper> mapper_ = std::make_unique<SemanticMapper>(MapperConfig{});
  int keyframes_ = 0;
};

TEST(Change, WhatStoodForTenMinutesIsGoneAfterFiveKeyframesThroughIt) {
  Room room;
  room.see(true, Room::kLong);
  const int before = room.voxels_of_box();
  ASSERT_GT(before, 150);
  const int wall = room.voxels_of_wall();
  room.see(false, 4);
  EXPECT_GT(room.voxels_of_box(), before / 2) << "the fifth decides";
  room.see(false, 1);
  EXPECT_LE(room.voxels_of_box(), before / 10) << "edges that were missed now and then, of " << before;
  room.see(false, 4);
  EXPECT_EQ(room.voxels_of_box(), 0) << "after the paper's nine";
  EXPECT_GE(room.voxels_of_wall(), wall);
}

TEST(Change, WhatIsCarriedAwayBetweenTwoVisitsIsGoneAfterThreeKeyframes) {
  Room room;
  room.see(true, Room::kLong);
  const int before = room.voxels_of_box();
  const int wall = room.voxels_of_wall();
  room.come_back();
  EXPECT_EQ(room.voxels_of_box(), before);
  room.see(false, 3);
  EXPECT_LE(room.voxels_of_box(), before / 10);
  EXPECT_GE(room.voxels_of_wall(), wall);
}

TEST(Change, WhatIsSeenToStandOnTheNextVisitTakesAsManyAsBefore) {
  Room room;
  room.see(true, Room::kLong);
  const int before = room.voxels_of_box();
  room.come_back();
  room.see(true, 8);
  room.see(false, 4);
  EXPECT_GT(room.voxels_of_box(), before / 2) << "the fifth decides";
}

TEST(Change, WhatIsPutWhereNothingWasForTenMinutesIsInAfterThreeKeyframes) {
  Room room;
  room.see(false, Room::kLong);
  ASSERT_EQ(room.voxels_of_box(), 0);
  room.see(true, 2);
  EXPECT_EQ(room.voxels_of_box(), 0);
  room.see(true, 1);
  const int after = room.voxels_of_box();
  room.see(true, 20);
  EXPECT_GE(after, 0.8 * room.voxels_of_box());
}

TEST(Change, WhatComesBackIsThereAgainAfterThreeKeyframes) {
  Room room;
  room.see(true, Room::kLong);
  room.see(false, Room::kLong);
  ASSERT_EQ(room.voxels_of_box(), 0);
  room.see(true, 3);
  EXPECT_GT(room.voxels_of_box(), 150);
}

}  // namespace
}  // namespace rds::mapper
