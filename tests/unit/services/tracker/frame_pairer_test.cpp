// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/input/frame_pairer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rds::tracker {
namespace {
using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::int64_t kMs = 1'000'000;

image::ColorImage color(int width = 8) {
  return {cv::Mat(6, width, CV_8UC3), image::ChannelOrder::kBgr, nullptr};
}
image::DepthImage depth() {
  return {cv::Mat(6, 8, CV_16UC1, cv::Scalar(1500)), 0.001F, nullptr};
}

FramePairer pairer_with_camera() {
  FramePairer pairer(20 * kMs);
  pairer.set_camera({8, 6, 10, 10, 4, 3, {}});
  return pairer;
}

/// Stamps in ms; those of frames without depth are negative.
std::vector<std::int64_t> stamps(const FramePairer::Frames& frames) {
  std::vector<std::int64_t> all;
  for (const auto& frame : frames)
    all.push_back(frame.stamp_ns / kMs * (cv::countNonZero(frame.depth.values) > 0 ? 1 : -1));
  return all;
}

TEST(FramePairer, PairsInEitherOrderOfArrival) {
  FramePairer pairer = pairer_with_camera();
  EXPECT_THAT(pairer.add_color(100 * kMs, color()), IsEmpty());
  EXPECT_THAT(stamps(pairer.add_depth(110 * kMs, depth())), ElementsAre(100));
  EXPECT_THAT(pairer.add_depth(133 * kMs, depth()), IsEmpty());
  EXPECT_THAT(stamps(pairer.add_color(134 * kMs, color())), ElementsAre(134));
  EXPECT_EQ(pairer.unpaired() + pairer.without_depth(), 0U);
}

TEST(FramePairer, AColourPictureGoesOnAloneOnceALaterDepthPictureIsThere) {
  FramePairer pairer = pairer_with_camera();
  EXPECT_THAT(pairer.add_color(100 * kMs, color()), IsEmpty());
  EXPECT_THAT(pairer.add_depth(79 * kMs, depth()), IsEmpty());
  EXPECT_THAT(stamps(pairer.add_depth(121 * kMs, depth())), ElementsAre(-100));
  EXPECT_THAT(stamps(pairer.add_color(125 * kMs, color())), ElementsAre(125));
  EXPECT_EQ(pairer.without_depth(), 1U);
  EXPECT_EQ(pairer.unpaired(), 1U);  // depth at 79
}

TEST(FramePairer, ForgetsWhatCameBeforeTheCamera) {
  FramePairer pairer(20 * kMs);
  EXPECT_THAT(pairer.add_color(100 * kMs, color()), IsEmpty());
  EXPECT_THAT(pairer.add_depth(133 * kMs, depth()), IsEmpty());
  pairer.forget_waiting();
  EXPECT_THAT(pairer.set_camera({8, 6, 10, 10, 4, 3, {}}), IsEmpty());
  EXPECT_THAT(pairer.add_color(133 * kMs, color()), IsEmpty());
  EXPECT_EQ(pairer.unpaired(), 2U);
}

TEST(FramePairer, FramesKeepTheOrderOfTheirStamps) {
  FramePairer pairer = pairer_with_camera();
  for (const int ms : {100, 133, 166}) EXPECT_THAT(pairer.add_color(ms * kMs, color()), IsEmpty());
  EXPECT_THAT(stamps(pairer.add_depth(166 * kMs, depth())), ElementsAre(-100, -133, 166));
  EXPECT_THAT(pairer.add_color(150 * kMs, color()), IsEmpty());
  EXPECT_THAT(stamps(pairer.add_depth(200 * kMs, depth())), IsEmpty()) << "150 after 166";
  EXPECT_EQ(pairer.unpaired(), 1U);
}

TEST(FramePairer, DepthThatIsAheadWaitsForItsColour) {
  FramePairer pairer = pairer_with_camera();
  for (const int ms : {100, 133, 166}) EXPECT_THAT(pairer.add_depth(ms * kMs, depth()), IsEmpty());
  EXPECT_THAT(stamps(pairer.add_color(101 * kMs, color())), ElementsAre(101));
  EXPECT_THAT(stamps(pairer.add_color(165 * kMs, color())), ElementsAre(165));
  EXPECT_EQ(pairer.unpaired(), 1U);
}

TEST(FramePairer, ADepthStreamThatBreaksOffDoesNotHoldColourForLong) {
  FramePairer pairer = pairer_with_camera();
  for (int i = 0; i < 100; ++i) EXPECT_THAT(pairer.add_color(i * 100 * kMs, color()), IsEmpty());
  EXPECT_EQ(pairer.unpaired(), 95U) << "no depth has ever come";
  EXPECT_THAT(stamps(pairer.add_depth(9900 * kMs, depth())), ElementsAre(-9500, -9600, -9700, -9800, 9900));
  for (int i = 100; i < 105; ++i) EXPECT_THAT(pairer.add_color(i * 100 * kMs, color()), IsEmpty());
  EXPECT_THAT(stamps(pairer.add_color(10500 * kMs, color())), ElementsAre(-10000));
}

TEST(FramePairer, FramesGoOnWhereStampsGoBack) {
  FramePairer pairer = pairer_with_camera();
  for (const int ms : {9000, 9033}) {
    EXPECT_THAT(pairer.add_color(ms * kMs, color()), IsEmpty());
    EXPECT_THAT(stamps(pairer.add_depth(ms * kMs, depth())), ElementsAre(ms));
  }
  EXPECT_THAT(pairer.add_depth(9066 * kMs, depth()), IsEmpty()) << "its colour is lost on the way";
  for (const int ms : {1000, 1033, 9066}) {
    pairer.add_depth(ms * kMs, depth());
    EXPECT_THAT(stamps(pairer.add_color(ms * kMs, color())), ElementsAre(ms));
  }
  EXPECT_EQ(pairer.without_depth(), 0U);
}

TEST(FramePairer, ColourWithoutDepthGoesOnWhereStampsGoBack) {
  FramePairer pairer = pairer_with_camera();
  pairer.add_depth(9000 * kMs, depth());
  EXPECT_THAT(stamps(pairer.add_color(9000 * kMs, color())), ElementsAre(9000));
  for (int i = 0; i < 5; ++i) EXPECT_THAT(pairer.add_color((1000 + 33 * i) * kMs, color()), IsEmpty());
  EXPECT_THAT(stamps(pairer.add_color(1166 * kMs, color())), ElementsAre(-1000));
}

TEST(FramePairer, ALoneColourFarAheadHoldsNobodyUp) {
  FramePairer pairer = pairer_with_camera();
  EXPECT_THAT(pairer.add_color(1'001'000 * kMs, color()), IsEmpty());
  EXPECT_THAT(stamps(pairer.add_depth(1000 * kMs, depth())), ElementsAre(-1'001'000));
  EXPECT_THAT(pairer.add_color(1033 * kMs, color()), IsEmpty());
  EXPECT_THAT(stamps(pairer.add_depth(1033 * kMs, depth())), ElementsAre(1033));
}

TEST(FramePairer, BoundsDepthThatWaits) {
  FramePairer pairer = pairer_with_camera();
  for (int i = 0; i < 100; ++i) EXPECT_THAT(pairer.add_depth(i * 100 * kMs, depth()), IsEmpty());
  EXPECT_EQ(pairer.unpaired(), 95U);
}

TEST(FramePairer, KeepsTheFirstFrameUntilTheCameraIsKnown) {
  FramePairer pairer(20 * kMs);
  EXPECT_THAT(pairer.add_color(0, color()), IsEmpty());
  EXPECT_THAT(pairer.add_depth(0, depth()), IsEmpty());
  const auto frames = pairer.set_camera({8, 6, 10, 10, 4, 3, {}});
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames.front().camera.width, 8);
  EXPECT_THAT(pairer.set_camera({8, 6, 10, 10, 4, 3, {}}), IsEmpty());
}

TEST(FramePairer, GivesUpPicturesOfAnotherSize) {
  FramePairer pairer = pairer_with_camera();
  EXPECT_THAT(pairer.add_color(50 * kMs, color(9)), IsEmpty());
  EXPECT_THAT(pairer.add_depth(50 * kMs, depth()), IsEmpty());
  EXPECT_EQ(pairer.unpaired(), 2U);
}

}  // namespace
}  // namespace rds::tracker
