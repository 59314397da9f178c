// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/rendering/lens.hpp"

#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace rds::simulator {
namespace {

const geometry::CameraModel kKinect{320, 240, 258, 258, 159, 127, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};

TEST(Lens, WithoutDistortionChangesNothing) {
  geometry::CameraModel camera = kKinect;
  camera.distortion = {};
  const Lens lens(camera);
  EXPECT_EQ(lens.ideal(), camera);
  cv::Mat picture(camera.height, camera.width, CV_32FC1);
  const void* const data = picture.data;
  lens.distort(picture, cv::INTER_LINEAR);
  EXPECT_EQ(picture.data, data);
}

TEST(Lens, APixelShowsWhatLiesInItsRay) {
  const Lens lens(kKinect);
  EXPECT_FALSE(lens.ideal().has_distortion());
  cv::Mat picture(lens.ideal().height, lens.ideal().width, CV_32FC2);  // x and y of each ray
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      const Eigen::Vector3f ray = lens.ideal().ray({x, y}).cast<float>();
      picture.at<cv::Vec2f>(y, x) = {ray.x(), ray.y()};
    }
  lens.distort(picture, cv::INTER_LINEAR);
  ASSERT_EQ(picture.size(), cv::Size(kKinect.width, kKinect.height));
  for (int y = 0; y < picture.rows; y += 7)
    for (int x = 0; x < picture.cols; x += 7) {
      const Eigen::Vector3d ray = kKinect.ray({x, y});
      const auto seen = picture.at<cv::Vec2f>(y, x);
      EXPECT_NEAR(static_cast<double>(seen[0]), ray.x(), 2e-4) << x << ' ' << y;
      EXPECT_NEAR(static_cast<double>(seen[1]), ray.y(), 2e-4) << x << ' ' << y;
    }
}

TEST(Lens, RefusesADistortionThatFoldsThePicture) {
  geometry::CameraModel camera = kKinect;
  camera.distortion = {-5, 0, 0, 0, 0};
  EXPECT_THROW(Lens{camera}, std::invalid_argument);
}

}  // namespace
}  // namespace rds::simulator
