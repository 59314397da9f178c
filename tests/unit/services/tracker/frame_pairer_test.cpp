// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/input/frame_pairer.hpp"

#include <algorithm>
#include <map>

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

/// Pictures of a driver whose depth is stamped later by `late_ms` [ms] in turn.
/// @return of 60 colour pictures at 15 Hz, which found a partner.
std::vector<bool> partners(FramePairer& pairer, const std::vector<int>& late_ms) {
  FramePairer::Frames frames;
  const auto add = [&](FramePairer::Frames made) { frames.insert(frames.end(), made.begin(), made.end()); };
  std::multimap<std::int64_t, bool> arrivals;  // stamps [ms] and whether of colour
  for (std::size_t i = 0; i < 60; ++i) {
    const auto stamp_ms = static_cast<std::int64_t>(1000 + 66 * i);
    arrivals.emplace(stamp_ms, true);
    arrivals.emplace(stamp_ms + late_ms[i % late_ms.size()], false);
  }
  for (const auto& [stamp_ms, is_color] : arrivals)
    add(is_color ? pairer.add_color(stamp_ms * kMs, color()) : pairer.add_depth(stamp_ms * kMs, depth()));
  std::vector<bool> found;
  for (const std::int64_t stamp : stamps(frames)) found.push_back(stamp > 0);
  return found;
}

TEST(FramePairer, LearnsThatDepthIsAlwaysStampedLaterOrEarlier) {
  for (const int late_ms : {31, 27, -30}) {
    FramePairer pairer = pairer_with_camera();
    const auto found = partners(pairer, {late_ms, late_ms + 2, late_ms - 1});
    EXPECT_EQ(std::ranges::count(found, false), 20) << "until it was learned";
    EXPECT_TRUE(std::all_of(found.begin() + 20, found.end(), [](bool pair) { return pair; })) << late_ms;
    EXPECT_NEAR(static_cast<double>(pairer.depth_offset_ns()) / kMs, late_ms, 2);
  }
}

TEST(FramePairer, LearnsWhereHalfOfThePicturesFindTheirPartner) {
  FramePairer pairer = pairer_with_camera();
  const auto found = partners(pairer, {18, 22, 19, 23});
  EXPECT_EQ(std::count(found.begin() + 20, found.end(), false), 0);
}

TEST(FramePairer, LearnsNothingWherePicturesArePairedOrGapsDiffer) {
  for (const auto& late_ms : {std::vector{15, 19, 12}, std::vector{30, -30}, std::vector{5, 5, 45}}) {
    FramePairer pairer = pairer_with_camera();
    partners(pairer, late_ms);
    EXPECT_EQ(pairer.depth_offset_ns(), 0);
  }
  FramePairer of_another_clock = pairer_with_camera();
  EXPECT_EQ(std::ranges::count(partners(of_another_clock, {7000}), true), 0);
  EXPECT_EQ(of_another_clock.depth_offset_ns(), 0);
}

}  // namespace
}  // namespace rds::tracker
