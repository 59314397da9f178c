// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/lens.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace rds::geometry {
namespace {

Lens lens(LensModel model, const std::array<double, 8>& coefficients) {
  return {.width = 640,
          .height = 480,
          .fx = 500,
          .fy = 510,
          .cx = 320,
          .cy = 240,
          .model = model,
          .coefficients = coefficients};
}

TEST(Lens, OfAPlumbBobIsTheCameraModel) {
  const Lens plain = lens(LensModel::kPlumbBob, {.1, -.2, .01, .02, .3});
  ASSERT_TRUE(plain.is_plain());
  for (const Eigen::Vector3d& point :
       {Eigen::Vector3d(.3, -.2, 1), Eigen::Vector3d(-1, .5, 2), Eigen::Vector3d(0, 0, 3)})
    EXPECT_TRUE(plain.project(point).isApprox(plain.camera().project(point), 1e-12)) << point.transpose();
}

/// Values by hand: r² = .25, radial (1 + .1 · .25) / (1 + .2 · .25).
TEST(Lens, OfARationalPolynomialDividesByTheLastThree) {
  const Lens rational = lens(LensModel::kRationalPolynomial, {.1, 0, 0, 0, 0, .2, 0, 0});
  EXPECT_FALSE(rational.is_plain());
  EXPECT_NEAR(rational.project({.5, 0, 1}).x(), 320 + 500 * .5 * 1.025 / 1.05, 1e-9);
  EXPECT_FALSE(rational.camera().has_distortion()) << "of the pictures after resampling";
}

/// Without coefficients the picture's radius is the angle: a ray at 45° falls on f · π / 4.
TEST(Lens, OfAnEquidistantProjectionMeasuresAngles) {
  const Lens fisheye = lens(LensModel::kEquidistant, {});
  EXPECT_NEAR(fisheye.project({1, 0, 1}).x(), 320 + 500 * M_PI / 4, 1e-9);
  EXPECT_NEAR(fisheye.project({0, 0, 1}).y(), 240, 1e-12);
  const Lens bent = lens(LensModel::kEquidistant, {.1});
  const double angle = M_PI / 4;
  EXPECT_NEAR(bent.project({0, 1, 1}).y(), 240 + 510 * angle * (1 + .1 * angle * angle), 1e-9);
}

TEST(Lens, KnowsTheRayOfEachPixel) {
  for (const Lens& each :
       {lens(LensModel::kPlumbBob, {}), lens(LensModel::kPlumbBob, {.1, -.2, .01, .02, .3}),
        lens(LensModel::kRationalPolynomial, {.3, -.1, .001, .002, .02, .2, .01, .005}),
        lens(LensModel::kEquidistant, {.02, -.01, .003, -.001})})
    for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(0, 0), {300, 200}, {639, 479}, {12.5, 460.25}}) {
      const auto ray = each.ray(pixel);
      ASSERT_TRUE(ray) << pixel.transpose();
      EXPECT_EQ(ray->z(), 1);
      EXPECT_LT((each.project(*ray) - pixel).norm(), 2e-3) << pixel.transpose();
    }
}

TEST(Lens, HasNoRayWhereItsDistortionFoldsBack) {
  const Lens folded = lens(LensModel::kPlumbBob, {-0.5});  // r (1 − r²/2) is .54 at most
  EXPECT_TRUE(folded.ray({folded.cx + 0.4 * folded.fx, folded.cy}));
  EXPECT_FALSE(folded.ray({folded.cx + 0.6 * folded.fx, folded.cy}));
}

}  // namespace
}  // namespace rds::geometry
