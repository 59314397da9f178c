// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/motion/motion_model.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace rds::tracker {
namespace {

using geometry::Pose;

constexpr std::int64_t kStepNs = 100'000'000;  // 0.1 s

/// A camera that moves by 0.05 m along x in each step.
class ConstantVelocity : public ::testing::Test {
 protected:
  ConstantVelocity() {
    observe(0);
    observe(1);
  }
  static Pose map_from_camera(int step) {
    Pose pose = Pose::Identity();
    pose.translation().x() = 0.05 * step;
    return pose;
  }
  [[nodiscard]] MotionPrediction predict(int step) const {
    return model.predict(map_from_camera(last_step), step * kStepNs);
  }
  void observe(int step) {
    const Pose camera_from_map = map_from_camera(step).inverse();
    model.observe(predict(step), camera_from_map, true);
    model.start_from(step * kStepNs);
    last_step = step;
  }

  MotionModel model;
  int last_step = 0;
};

TEST(MotionModel, KnowsNothingBeforeTheFirstPose) {
  const MotionPrediction prediction = MotionModel().predict(Pose::Identity(), kStepNs);
  EXPECT_TRUE(std::isinf(prediction.gap_s()));
  EXPECT_TRUE(prediction.velocity().isZero());
  EXPECT_FALSE(prediction.velocity_to(Pose::Identity()));
  EXPECT_EQ(prediction.innovation(Pose::Identity()), 0);
}

TEST_F(ConstantVelocity, GoesOn) {
  const MotionPrediction prediction = predict(2);
  EXPECT_TRUE(prediction.camera_from_map().isApprox(map_from_camera(2).inverse(), 1e-12));
  EXPECT_NEAR(prediction.velocity().head<3>().norm(), 0.5, 1e-12);
  EXPECT_NEAR(prediction.innovation(map_from_camera(2).inverse()), 0, 1e-9);
  EXPECT_FALSE(prediction.is_jump(map_from_camera(2).inverse()));
}

TEST_F(ConstantVelocity, IsNoGuessAfterALongGap) {
  const MotionPrediction prediction = predict(7);
  EXPECT_TRUE(prediction.camera_from_map().isApprox(map_from_camera(1).inverse(), 1e-12));
  EXPECT_TRUE(prediction.velocity().isZero());
  EXPECT_FALSE(prediction.is_jump(map_from_camera(100).inverse())) << "the camera may be anywhere";
}

TEST_F(ConstantVelocity, TellsWhatNoHandDoes) {
  const MotionPrediction prediction = predict(2);
  EXPECT_GT(prediction.innovation(map_from_camera(6).inverse()), 1);
  EXPECT_FALSE(prediction.is_jump(map_from_camera(6).inverse()));
  EXPECT_TRUE(prediction.is_jump(map_from_camera(20).inverse())) << "9.5 m/s";
}

TEST_F(ConstantVelocity, ReachesNoFarPlaceInAMoment) {
  const auto ahead = [&](double distance_m) {
    geometry::Pose place = map_from_camera(1);
    place.translation().z() += distance_m;
    return place;
  };
  EXPECT_TRUE(predict(2).can_be_near(ahead(1)));
  EXPECT_FALSE(predict(2).can_be_near(ahead(4)));
  EXPECT_TRUE(predict(31).can_be_near(ahead(4))) << "after 3 s it may have walked there";
  EXPECT_TRUE(MotionPrediction().can_be_near(ahead(100)));
}

TEST_F(ConstantVelocity, HasNoVelocityAfterARelocalisation) {
  model.observe(predict(2), map_from_camera(2).inverse(), false);
  EXPECT_TRUE(predict(2).velocity().isZero());
}

}  // namespace
}  // namespace rds::tracker
