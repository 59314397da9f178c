// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/object_filter.hpp"

#include <gtest/gtest.h>

namespace rds::tracker::prediction {
namespace {

constexpr double kStep = 0.2;  // s

/// A box in a plane 2 m before a camera that stands in the map's origin.
geometry::OrientedBox box_between(double left, double right, double top = -0.6, double bottom = 0.6) {
  geometry::OrientedBox box;
  box.map_from_box.translation() = Eigen::Vector3d((left + right) / 2, (top + bottom) / 2, 2);
  box.size = {right - left, bottom - top, 0.6};
  return box;
}

double left_of(const ObjectFilter& filter) {
  return filter.center().x() - filter.box().size.x() / 2;
}
double right_of(const ObjectFilter& filter) {
  return filter.center().x() + filter.box().size.x() / 2;
}

void step(ObjectFilter& filter, const geometry::OrientedBox& box, const CutSides& cut = {}) {
  filter.predict(kStep);
  filter.correct(box, cut);
}

TEST(ObjectFilter, LearnsTheVelocityOfABoxThatMovesAsAWhole) {
  ObjectFilter filter(box_between(0, 0.6), {});
  for (int k = 1; k <= 10; ++k) step(filter, box_between(0.1 * k, 0.6 + 0.1 * k));
  EXPECT_NEAR(filter.velocity().x(), 0.5, 0.03);
  EXPECT_NEAR(filter.velocity().y(), 0, 1e-9);
  EXPECT_NEAR(filter.box().size.x(), 0.6, 0.01);
}

TEST(ObjectFilter, DoesNotTakeAnArmStretchedOutForMotion) {
  ObjectFilter filter(box_between(0, 0.6), {});
  for (int k = 1; k <= 5; ++k) step(filter, box_between(0, 0.6));
  step(filter, box_between(0, 1.1));
  EXPECT_NEAR(filter.velocity().x(), 0, 1e-9);
  EXPECT_NEAR(left_of(filter), 0, 0.05);
  EXPECT_GT(right_of(filter), 1.0) << "but the box follows";
}

TEST(ObjectFilter, SomebodyWhoLeavesThePictureKeepsItsSizeAndVelocity) {
  ObjectFilter filter(box_between(-0.4, 0.2), {});
  for (int k = 1; k <= 10; ++k) {  // the picture ends at x = −1
    const double left = -0.4 - 0.1 * k;
    step(filter, box_between(std::max(-1., left), left + 0.6), {.left = left < -1});
  }
  EXPECT_NEAR(filter.velocity().x(), -0.5, 0.05);
  EXPECT_NEAR(filter.box().size.x(), 0.6, 0.05);
  EXPECT_NEAR(right_of(filter), -0.8, 0.05);
}

TEST(ObjectFilter, SomebodyWhoEntersThePictureMovesWithTheSideThatIsSeen) {
  ObjectFilter filter(box_between(-1, -0.95), {.left = true});
  EXPECT_NEAR(filter.box().size.x(), ObjectFilter::kMinWidthM, 1e-9) << "the rest is outside";
  for (int k = 1; k <= 8; ++k) {
    const double right = -0.95 + 0.1 * k;
    step(filter, box_between(std::max(-1., right - 0.6), right), {.left = right - 0.6 < -1});
  }
  EXPECT_NEAR(filter.velocity().x(), 0.5, 0.1);
  EXPECT_NEAR(right_of(filter), -0.15, 0.05);
}

TEST(ObjectFilter, IsMoreSurprisedByWhatIsFurtherAway) {
  ObjectFilter filter(box_between(0, 0.6), {});
  filter.predict(kStep);
  const double near = filter.mahalanobis(box_between(0.1, 0.7), {});
  const double far = filter.mahalanobis(box_between(0.5, 1.1), {});
  EXPECT_LT(near, far);
  EXPECT_NEAR(filter.mahalanobis(box_between(0, 0.6), {}), 0, 1e-9);
}

TEST(ObjectFilter, TrustsADepthLessThanAPlaceInThePicture) {
  ObjectFilter filter(box_between(0, 0.6), {});
  EXPECT_GT(filter.center_sigma_in_box().z(), filter.center_sigma_in_box().x());
  filter.predict(1);
  EXPECT_LT(filter.center_sigma_in_box().y(), filter.center_sigma_in_box().x()) << "nobody jumps";
}

}  // namespace
}  // namespace rds::tracker::prediction
