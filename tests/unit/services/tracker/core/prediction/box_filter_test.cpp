// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/sort/box_filter.hpp"

#include <gtest/gtest.h>

namespace rds::tracker::prediction {
namespace {

geometry::Box2 moving_box(double t) {
  return {100 + 6 * t, 50 - 3 * t, 140 + 6 * t, 150 - 3 * t};
}

TEST(BoxFilter, StartsAsTheBoxItWasMadeFrom) {
  const geometry::Box2 box = BoxFilter({10, 20, 40, 100}).box();
  EXPECT_NEAR(box.x0, 10, 1e-9);
  EXPECT_NEAR(box.y0, 20, 1e-9);
  EXPECT_NEAR(box.x1, 40, 1e-9);
  EXPECT_NEAR(box.y1, 100, 1e-9);
}

TEST(BoxFilter, LearnsAConstantVelocityFromUnevenSteps) {
  BoxFilter filter(moving_box(0));
  double t = 0;
  for (const double step : {3.0, 1.0, 2.5, 4.0, 0.5, 3.0, 2.0}) {
    t += step;
    filter.predict(step);
    filter.correct(moving_box(t));
  }
  EXPECT_NEAR(filter.velocity().x(), 6, 0.1);
  EXPECT_NEAR(filter.velocity().y(), -3, 0.1);
  filter.predict(4);
  EXPECT_NEAR(filter.box().x0, moving_box(t + 4).x0, 1);
  EXPECT_NEAR(filter.box().y1, moving_box(t + 4).y1, 1);
}

TEST(BoxFilter, KeepsTheAreaPositiveWhenABoxShrank) {
  BoxFilter filter({0, 0, 100, 100});
  for (double side : {80., 60., 40., 20.}) {
    filter.predict(1);
    filter.correct({50 - side / 2, 50 - side / 2, 50 + side / 2, 50 + side / 2});
  }
  filter.predict(30);
  EXPECT_TRUE(filter.is_finite());
  EXPECT_GT(filter.box().area(), 0);
}

TEST(BoxFilter, GrowsMoreUncertainWithTimeAndLessWithMeasurements) {
  BoxFilter filter({0, 0, 100, 100});
  filter.predict(1);
  const double before = filter.center_variance().x();
  filter.correct({0, 0, 100, 100});
  const double after = filter.center_variance().x();
  EXPECT_LT(after, before);
  filter.predict(5);
  EXPECT_GT(filter.center_variance().x(), after);
}

}  // namespace
}  // namespace rds::tracker::prediction
