// SPDX-License-Identifier: Apache-2.0
#include "common/keyframe_codec/byte_planes.hpp"

#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>

#include "tests/unit/common/keyframe_codec/example_pictures.hpp"

namespace rds::keyframe_codec {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes planes_of(const cv::Mat& pixels) {
  Bytes planes(pixels.total() * pixels.elemSize());
  to_byte_planes(pixels, planes);
  return planes;
}

void expect_same_after(const cv::Mat& pixels) {
  cv::Mat again(pixels.size(), pixels.type());
  from_byte_planes(planes_of(pixels), again);
  for (int y = 0; y < pixels.rows; ++y)
    ASSERT_EQ(
        std::memcmp(again.ptr(y), pixels.ptr(y), pixels.elemSize() * static_cast<std::size_t>(pixels.cols)),
        0)
        << "row " << y << " of " << pixels.size();
}

TEST(BytePlanes, AreZigzagDifferencesLowestBytesFirst) {
  const cv::Mat1w pixels = (cv::Mat1w(2, 3) << 300, 299, 300, 302, 302, 46);
  // Differences: 300, -1, 1; 2 (to 300 above), 0, -256.
  EXPECT_THAT(planes_of(pixels), testing::ElementsAre(600 & 0xFF, 1, 2, 4, 0, 0xFF, 600 >> 8, 0, 0, 0, 0, 1));
}

TEST(BytePlanes, KeepEveryValueOfEveryWidth) {
  cv::RNG random(2);
  for (const int type : {CV_8UC1, CV_16UC1, CV_32SC1}) {
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 5), cv::Size(17, 2), cv::Size(64, 48)}) {
      cv::Mat pixels(size, type);
      random.fill(pixels, cv::RNG::UNIFORM, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
      expect_same_after(pixels);
    }
  }
}

TEST(BytePlanes, KeepJumpsBetweenSmallestAndLargest) {
  expect_same_after((cv::Mat1w(2, 4) << 0, 65535, 0, 32768, 65535, 0, 32767, 1));
  expect_same_after((cv::Mat1b(1, 4) << 0, 255, 128, 0));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  expect_same_after((cv::Mat1f(2, 3) << 0.F, -0.F, nan, infinity, -infinity, 1.234F));
}

TEST(BytePlanes, SkipThePaddingOfRows) {
  const cv::Mat1w depth = test::example_depth({5, 3});
  const cv::Mat padded = test::with_padding(depth, 3);
  EXPECT_EQ(planes_of(padded), planes_of(depth));
  cv::Mat target = test::with_padding(cv::Mat1w(3, 5, std::uint16_t{0}), 3);
  from_byte_planes(planes_of(depth), target);
  EXPECT_EQ(cv::norm(target, depth, cv::NORM_L1), 0);
}

TEST(BytePlanes, RefuseOtherPixelsAndLengths) {
  Bytes planes(24);
  EXPECT_THROW(to_byte_planes(cv::Mat(2, 3, CV_8UC3), planes), std::invalid_argument);
  EXPECT_THROW(to_byte_planes(cv::Mat(1, 3, CV_64FC1), planes), std::invalid_argument);
  EXPECT_THROW(to_byte_planes(cv::Mat(2, 3, CV_16UC1), planes), std::invalid_argument);
  cv::Mat target(2, 3, CV_16UC1);
  EXPECT_THROW(from_byte_planes(planes, target), std::invalid_argument);
}

}  // namespace
}  // namespace rds::keyframe_codec
