// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/plane_tracking.hpp"

#include <gmock/gmock.h>

#include "tests/unit/services/tracker/core/prediction/scene.hpp"

namespace rds::tracker::prediction {
namespace {

using scene::nanoseconds;
using ::testing::SizeIs;

ObjectObservation box_at(const Eigen::Vector3d& center, const std::string& label = "person") {
  ObjectObservation observation{{}, label, 0.9F};
  observation.box.map_from_box.translation() = center;
  observation.box.size = {0.5, 0.9, 0.6};
  return observation;
}

TEST(PlaneTracking, RecombinesEveryObjectFromItsThreePlanes) {
  PlaneTracking tracking;
  const std::vector<Eigen::Vector3d> velocity = {{0.6, 0, 0}, {0, 0.5, 0.3}, {-0.4, 0, -0.6}};
  const std::vector<Eigen::Vector3d> start = {{-2, 0, 3}, {0, -0.5, 5}, {2, 0.5, 8}};
  for (int k = 0; k <= 10; ++k) {
    std::vector<ObjectObservation> seen;
    for (std::size_t i = 0; i < start.size(); ++i) seen.push_back(box_at(start[i] + 0.2 * k * velocity[i]));
    tracking.update(nanoseconds(1 + 0.2 * k), seen, nullptr);
  }
  const auto objects = tracking.predict(nanoseconds(3.2));
  ASSERT_THAT(objects, SizeIs(3));
  for (std::size_t i = 0; i < start.size(); ++i) {
    EXPECT_EQ(objects[i].id, i + 1);
    EXPECT_LT((objects[i].box.center() - (start[i] + 2.2 * velocity[i])).norm(), 0.06) << i;
    EXPECT_LT((objects[i].velocity - velocity[i]).norm(), 0.15) << i;
    EXPECT_LT((objects[i].box.size - Eigen::Vector3d(0.5, 0.9, 0.6)).norm(), 0.1) << i;
  }
}

TEST(PlaneTracking, TellsObjectsApartThatOnePlaneCannot) {
  PlaneTracking tracking;
  for (int k = 0; k <= 5; ++k)  // one behind the other: one box in plane xOy
    tracking.update(nanoseconds(1 + 0.2 * k), std::vector{box_at({0, 0, 2}), box_at({0, 0, 5})}, nullptr);
  const auto objects = tracking.predict(nanoseconds(2.1));
  ASSERT_THAT(objects, SizeIs(2));
  EXPECT_NE(objects[0].id, objects[1].id);
}

TEST(PlaneTracking, HandlesABoxThatIsTurnedAgainstTheMap) {
  PlaneTracking tracking;
  ObjectObservation turned = box_at({1, 2, 3});
  turned.box.map_from_box.linear() =
      Eigen::AngleAxisd(0.9, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  for (int k = 0; k <= 5; ++k) tracking.update(nanoseconds(1 + 0.2 * k), std::vector{turned}, nullptr);
  const auto objects = tracking.predict(nanoseconds(2.1));
  ASSERT_THAT(objects, SizeIs(1));
  EXPECT_LT((objects[0].box.center() - turned.box.center()).norm(), 0.01);
  EXPECT_LT((objects[0].box.size - turned.box.size).norm(), 0.02);
}

}  // namespace
}  // namespace rds::tracker::prediction
