// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/features/image_pyramid.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace rds::tracker {
namespace {

/// Brightness x + 2y.
cv::Mat slope(int width, int height) {
  cv::Mat image(height, width, CV_8UC1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(x + 2 * y);
  return image;
}

TEST(ImagePyramid, HalvesUntilNothingIsLeft) {
  const ImagePyramid pyramid(slope(45, 10), 9);
  ASSERT_EQ(pyramid.levels(), 4);
  EXPECT_EQ(pyramid.level(1).size(), cv::Size(22, 5));
  EXPECT_EQ(pyramid.level(3).size(), cv::Size(5, 1));
}

TEST(ImagePyramid, SharesThePicture) {
  const cv::Mat image = slope(32, 32);
  EXPECT_EQ(ImagePyramid(image, 2).level(0).data, image.data);
}

TEST(ImagePyramid, IsCopiedWithAllLevels) {
  const ImagePyramid pyramid(slope(45, 10), 3);
  std::vector<std::uint8_t> memory(pyramid.bytes());
  const ImagePyramid copy = pyramid.copied_to(memory.data());
  EXPECT_EQ(memory.size(), 45U * 10 + 22 * 5 + 11 * 2);
  ASSERT_EQ(copy.levels(), 3);
  for (int l = 0; l < 3; ++l) EXPECT_EQ(cv::countNonZero(copy.level(l) != pyramid.level(l)), 0) << l;
  EXPECT_EQ(copy.level(2).data + copy.level(2).total(), memory.data() + memory.size());
}

TEST(ImagePyramid, ALevelShowsTheSameAtTheSamePlace) {
  const ImagePyramid pyramid(slope(64, 48), 4);
  const Eigen::Vector2f place(30.3F, 20.6F);
  for (int l = 0; l < 3; ++l) {
    const Eigen::Vector2f at = ImagePyramid::at_level(place, l);
    EXPECT_NEAR(interpolate(pyramid.level(l), at.x(), at.y()), 30.3 + 2 * 20.6, 0.51) << l;
    EXPECT_TRUE(ImagePyramid::at_picture(at, l).isApprox(place, 1e-5F));
  }
}

TEST(ImagePyramid, KnowsWhatCanBeInterpolated) {
  const ImagePyramid pyramid(slope(64, 48), 2);
  EXPECT_TRUE(pyramid.contains({4, 4}, 4, 0));
  EXPECT_FALSE(pyramid.contains({3.9F, 4}, 4, 0));
  EXPECT_TRUE(pyramid.contains({58.9F, 42.9F}, 4, 0));
  EXPECT_FALSE(pyramid.contains({59, 20}, 4, 0));
  EXPECT_FALSE(pyramid.contains({20, 20}, 4, 1));
  EXPECT_FALSE(pyramid.contains({std::nanf(""), 20}, 4, 0));
}

}  // namespace
}  // namespace rds::tracker
