// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/frame_pairer.hpp"

#include <gtest/gtest.h>

namespace rds::tracker {
namespace {

constexpr std::int64_t kMs = 1'000'000;

image::ColorImage color(int width = 8) {
  return {cv::Mat(6, width, CV_8UC3), image::ChannelOrder::kBgr, nullptr};
}
image::DepthImage depth() {
  return {cv::Mat(6, 8, CV_16UC1), 0.001F, nullptr};
}

FramePairer pairer_with_camera() {
  FramePairer pairer(20 * kMs);
  pairer.set_camera({8, 6, 10, 10, 4, 3, {}});
  return pairer;
}

TEST(FramePairer, PairsInEitherOrderOfArrival) {
  FramePairer pairer = pairer_with_camera();
  EXPECT_FALSE(pairer.add_color(100 * kMs, color()));
  const auto first = pairer.add_depth(110 * kMs, depth());
  ASSERT_TRUE(first);
  EXPECT_EQ(first->stamp_ns, 100 * kMs);
  EXPECT_FALSE(pairer.add_depth(133 * kMs, depth()));
  EXPECT_TRUE(pairer.add_color(134 * kMs, color()));
  EXPECT_EQ(pairer.unpaired(), 0U);
}

TEST(FramePairer, LeavesWhatIsTooFarApart) {
  FramePairer pairer = pairer_with_camera();
  EXPECT_FALSE(pairer.add_color(100 * kMs, color()));
  EXPECT_FALSE(pairer.add_depth(121 * kMs, depth()));
  EXPECT_TRUE(pairer.add_color(125 * kMs, color()));
  EXPECT_EQ(pairer.unpaired(), 1U);  // the first colour picture will never find a partner
}

TEST(FramePairer, BoundsWhatWaits) {
  FramePairer pairer = pairer_with_camera();
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(pairer.add_color(i * 100 * kMs, color()));
  EXPECT_EQ(pairer.unpaired(), 95U);
}

TEST(FramePairer, KeepsTheFirstFrameUntilTheCameraIsKnown) {
  FramePairer pairer(20 * kMs);
  EXPECT_FALSE(pairer.add_color(0, color()));
  EXPECT_FALSE(pairer.add_depth(0, depth()));
  const auto frame = pairer.set_camera({8, 6, 10, 10, 4, 3, {}});
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->camera.width, 8);
  EXPECT_FALSE(pairer.set_camera({8, 6, 10, 10, 4, 3, {}}));
}

TEST(FramePairer, GivesUpPicturesOfAnotherSize) {
  FramePairer pairer = pairer_with_camera();
  EXPECT_FALSE(pairer.add_color(50 * kMs, color(9)));
  EXPECT_FALSE(pairer.add_depth(50 * kMs, depth()));
  EXPECT_EQ(pairer.unpaired(), 2U);
}

}  // namespace
}  // namespace rds::tracker
