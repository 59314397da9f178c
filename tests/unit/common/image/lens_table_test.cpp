// SPDX-License-Identifier: Apache-2.0
#include "common/image/lens_table.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace rds::image {
namespace {

using geometry::Lens;
using geometry::LensModel;

/// What a camera sees of a wall 2 m away with a smooth pattern, by project(): exact for every lens.
struct Wall {
  static constexpr double kDepthM = 2;
  static std::uint8_t brightness(const Eigen::Vector3d& ray) {
    return static_cast<std::uint8_t>(std::lround(128 + 100 * std::sin(4 * ray.x()) * std::cos(3 * ray.y())));
  }
  static cv::Mat3b seen_by(const geometry::CameraModel& camera) {
    cv::Mat3b picture(camera.height, camera.width);
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) picture(y, x) = cv::Vec3b::all(brightness(camera.ray({x, y})));
    return picture;
  }
  /// Through a lens: each pixel's ray is found by iteration.
  static Eigen::Vector3d ray_of(const Lens& lens, int x, int y) {
    Eigen::Vector3d ray((x - lens.cx) / lens.fx, (y - lens.cy) / lens.fy, 1);
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector2d off = Eigen::Vector2d(x, y) - lens.project(ray);
      ray.x() += off.x() / lens.fx;
      ray.y() += off.y() / lens.fy;
    }
    return ray;
  }
  static cv::Mat3b seen_through(const Lens& lens) {
    cv::Mat3b picture(lens.height, lens.width);
    for (int y = 0; y < lens.height; ++y)
      for (int x = 0; x < lens.width; ++x) picture(y, x) = cv::Vec3b::all(brightness(ray_of(lens, x, y)));
    return picture;
  }
};

Lens lens(LensModel model, const std::array<double, 8>& coefficients) {
  return {.width = 160,
          .height = 120,
          .fx = 140,
          .fy = 140,
          .cx = 80,
          .cy = 60,
          .model = model,
          .coefficients = coefficients};
}

/// Apart from the border, where the source may show nothing.
double largest_difference(const cv::Mat& a, const cv::Mat& b) {
  const cv::Rect inside(20, 15, a.cols - 40, a.rows - 30);
  return cv::norm(a(inside), b(inside), cv::NORM_INF);
}

class Lenses : public ::testing::TestWithParam<Lens> {};

TEST_P(Lenses, PicturesBecomeThoseOfAPinholeCamera) {
  const LensTable table(GetParam(), GetParam().camera());
  const ColorImage picture = table.color({Wall::seen_through(GetParam()), ChannelOrder::kRgb, nullptr});
  EXPECT_EQ(picture.order, ChannelOrder::kRgb);
  EXPECT_LE(largest_difference(picture.pixels, Wall::seen_by(GetParam().camera())), 2);
}

INSTANTIATE_TEST_SUITE_P(Of, Lenses,
                         ::testing::Values(lens(LensModel::kRationalPolynomial,
                                                {.3, -.1, .001, .002, .02, .2, .01, .005}),
                                           lens(LensModel::kEquidistant, {.02, -.01, .003, -.001})));

TEST(LensTable, RegistersDepthOfAnotherSizeWithoutMixingSurfaces) {
  Lens half = lens(LensModel::kPlumbBob, {});
  half.width = 80, half.height = 60, half.fx = half.fy = 70, half.cx = 39.75, half.cy = 29.75;
  const geometry::CameraModel camera = lens(LensModel::kPlumbBob, {}).camera();
  cv::Mat1w depth(60, 80, std::uint16_t{1000});
  depth(cv::Rect(40, 0, 40, 60)) = 3000;
  const DepthImage registered = LensTable(half, camera).depth({depth, 0.001F, nullptr});
  ASSERT_EQ(registered.values.size(), cv::Size(160, 120));
  EXPECT_FLOAT_EQ(registered.at(70, 60), 1);
  EXPECT_FLOAT_EQ(registered.at(90, 60), 3);
  for (int x = 10; x < 150; ++x) {
    const bool is_either =
        std::abs(registered.at(x, 60) - 1) < 1e-6F || std::abs(registered.at(x, 60) - 3) < 1e-6F;
    EXPECT_TRUE(is_either) << x;
  }
}

TEST(LensTable, HasNoMeasurementWhereTheSourceShowsNothing) {
  Lens narrow = lens(LensModel::kPlumbBob, {});
  narrow.fx = narrow.fy = 280;  // sees half as much
  const LensTable table(narrow, lens(LensModel::kPlumbBob, {}).camera());
  const DepthImage depth = table.depth({cv::Mat1w(120, 160, std::uint16_t{1000}), 0.001F, nullptr});
  EXPECT_EQ(depth.at(80, 60), 1);
  EXPECT_EQ(depth.at(5, 5), 0);
}

}  // namespace
}  // namespace rds::image
