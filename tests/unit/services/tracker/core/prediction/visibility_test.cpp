// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/visibility.hpp"

#include <gtest/gtest.h>

#include "tests/unit/services/tracker/core/prediction/scene.hpp"

namespace rds::tracker::prediction {
namespace {

using geometry::Pose;

const KeyframeView kView{Pose::Identity(), scene::camera()};

ObjectObservation person_at(double x, double z) {
  return *scene::see_person({x, 0, z}, Pose::Identity());
}

TEST(Visibility, ExpectsADetectionOfWhatStandsFreelyInThePicture) {
  EXPECT_TRUE(should_be_detected(person_at(0, 3).box, {}, kView));
  EXPECT_TRUE(should_be_detected(person_at(0, 3).box, std::vector{person_at(1.5, 2)}, kView)) << "far aside";
  EXPECT_TRUE(should_be_detected(person_at(0, 3).box, std::vector{person_at(0, 4)}, kView)) << "behind it";
}

TEST(Visibility, ExpectsNoneOfWhatStandsBehindADetectedObject) {
  EXPECT_FALSE(should_be_detected(person_at(0.1, 3).box, std::vector{person_at(0, 2)}, kView));
}

TEST(Visibility, ExpectsNoneOfWhatIsMostlyOutsideThePictureOrBehindTheCamera) {
  geometry::OrientedBox box = person_at(0, 3).box;
  box.map_from_box.translation().x() = 3 * 320 / 500. + 0.05;
  EXPECT_FALSE(should_be_detected(box, {}, kView));
  box.map_from_box.translation() = Eigen::Vector3d(0, 0, -3);
  EXPECT_FALSE(should_be_detected(box, {}, kView));
}

TEST(Visibility, DoubtsWhatFillsThePictureWithALowScoreOnly) {
  ObjectObservation close = person_at(0, 0.42);
  EXPECT_FALSE(is_implausible(close, kView)) << "the network is sure";
  close.score = 0.5F;
  EXPECT_TRUE(is_implausible(close, kView));
  ObjectObservation farther = person_at(0, 1);
  farther.score = 0.5F;
  EXPECT_FALSE(is_implausible(farther, kView));
}

}  // namespace
}  // namespace rds::tracker::prediction
