// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/input_transform.hpp"

#include <gtest/gtest.h>

namespace rds::detector {
namespace {

InputDescription square_input(Resize resize) {
  InputDescription input;
  input.width = 416;
  input.height = 416;
  input.resize = resize;
  input.pad_value = 114;
  return input;
}

class Placement : public ::testing::TestWithParam<std::tuple<Resize, cv::Size>> {};

TEST_P(Placement, MapsTheCornersOfThePictureExactly) {
  const auto [resize, size] = GetParam();
  const InputTransform place = place_picture(square_input(resize), size.width, size.height);
  const geometry::Box2 in_input{place.offset_x, place.offset_y, place.offset_x + size.width * place.scale_x,
                                place.offset_y + size.height * place.scale_y};
  const geometry::Box2 back = place.to_picture(in_input);
  EXPECT_NEAR(back.x0, 0, 1e-9);
  EXPECT_NEAR(back.y0, 0, 1e-9);
  EXPECT_NEAR(back.x1, size.width, 1e-9);
  EXPECT_NEAR(back.y1, size.height, 1e-9);
}

TEST_P(Placement, StaysInsideTheInputOnWholePixels) {
  const auto [resize, size] = GetParam();
  const InputTransform place = place_picture(square_input(resize), size.width, size.height);
  const double right = place.offset_x + size.width * place.scale_x;
  const double bottom = place.offset_y + size.height * place.scale_y;
  EXPECT_LE(right, 416 + 1e-9);
  EXPECT_LE(bottom, 416 + 1e-9);
  EXPECT_NEAR(right, std::round(right), 1e-9);
  EXPECT_NEAR(bottom, std::round(bottom), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(
    AllSizes, Placement,
    ::testing::Combine(::testing::Values(Resize::kStretch, Resize::kLetterbox, Resize::kCentredLetterbox),
                       ::testing::Values(cv::Size(640, 480), cv::Size(641, 479), cv::Size(480, 640),
                                         cv::Size(1, 1), cv::Size(3000, 1), cv::Size(1, 3000),
                                         cv::Size(416, 416))));

TEST(InputTransform, LetterboxLeavesTheRestAtThePadValue) {
  const image::ColorImage white{cv::Mat(100, 200, CV_8UC3, cv::Scalar::all(255)), image::ChannelOrder::kBgr,
                                nullptr};
  const InputDescription input = square_input(Resize::kLetterbox);
  const cv::Mat tensor = make_input(input, place_picture(input, 200, 100), white);
  ASSERT_EQ(tensor.total(), 3U * 416 * 416);
  const auto* first_channel = tensor.ptr<float>(0, 0);
  EXPECT_EQ(first_channel[0], 255);
  EXPECT_EQ(first_channel[207 * 416 + 415], 255);
  EXPECT_EQ(first_channel[208 * 416], 114);
  EXPECT_EQ(first_channel[415 * 416 + 415], 114);
}

TEST(InputTransform, CentredLetterboxPutsThePictureInTheMiddle) {
  const InputTransform place = place_picture(square_input(Resize::kCentredLetterbox), 200, 100);
  EXPECT_EQ(place.offset_x, 0);
  EXPECT_EQ(place.offset_y, 104);
}

TEST(InputTransform, TakesMeanAndDeviationPerChannelInTheInputsOrder) {
  InputDescription input = square_input(Resize::kStretch);
  input.order = InputOrder::kRgb;
  input.mean = {10, 20, 30};
  input.deviation = {1, 2, 4};
  const image::ColorImage bgr{cv::Mat(8, 8, CV_8UC3, cv::Scalar(50, 40, 30)), image::ChannelOrder::kBgr,
                              nullptr};
  const image::ColorImage rgb{cv::Mat(8, 8, CV_8UC3, cv::Scalar(30, 40, 50)), image::ChannelOrder::kRgb,
                              nullptr};
  for (const auto& picture : {bgr, rgb}) {
    const cv::Mat tensor = make_input(input, place_picture(input, 8, 8), picture);
    EXPECT_FLOAT_EQ(tensor.ptr<float>(0, 0)[0], (30 - 10) / 1.0F);
    EXPECT_FLOAT_EQ(tensor.ptr<float>(0, 1)[0], (40 - 20) / 2.0F);
    EXPECT_FLOAT_EQ(tensor.ptr<float>(0, 2)[0], (50 - 30) / 4.0F);
  }
}

}  // namespace
}  // namespace rds::detector
