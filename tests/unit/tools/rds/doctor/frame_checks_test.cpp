// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/rds/doctor/checks/color_checks.hpp"
#include "tools/rds/doctor/checks/depth_checks.hpp"

namespace rds::doctor {
namespace {
using testing::HasSubstr;
using testing::Not;

std::vector<FrameLook> good_frames(std::size_t count = 100) {
  std::vector<FrameLook> frames;
  for (std::size_t i = 0; i < count; ++i)
    frames.push_back({static_cast<std::int64_t>(i) * 1'000'000'000,
                      {120 + static_cast<double>(i % 3), 60, 0.02},
                      {0.9, 0.8, 2.0, 4.0, 0.01, 2000},
                      4,
                      false});
  frames.front().color_change = std::numeric_limits<double>::quiet_NaN();
  return frames;
}

void scale_depth(std::vector<FrameLook>& frames, double factor) {
  for (auto& frame : frames)
    for (double* metres : {&frame.depth.near_m, &frame.depth.median_m, &frame.depth.far_m}) *metres *= factor;
}

TEST(FrameChecks, FindNothingWrongWithGoodFrames) {
  const auto frames = good_frames();
  for (const auto& finding :
       {check_frozen(frames), check_blur(frames), check_exposure(frames), check_exposure_jumps(frames),
        check_depth_scale(frames, 1000), check_depth_share(frames), check_depth_values(frames),
        check_depth_frozen(frames)})
    EXPECT_EQ(finding.verdict, Verdict::kGood) << finding.subject << ": " << finding.sentence;
}

TEST(FrameChecks, TellFewBadFramesFromMany) {
  auto frames = good_frames();
  for (std::size_t i = 40; i < 50; ++i) frames[i].color_change = 0.01;
  EXPECT_EQ(check_frozen(frames).verdict, Verdict::kHint);
  EXPECT_THAT(check_frozen(frames).sentence, HasSubstr("10 of 100 frames (10.0 %) repeat"));
  EXPECT_THAT(check_frozen(frames).sentence, HasSubstr("the first at 40.000000 s"));
  frames[50].color_change = 0;
  EXPECT_EQ(check_frozen(frames).verdict, Verdict::kFault);
}

TEST(BlurCheck, ComparesWithTheRecordingsOwnMedian) {
  auto frames = good_frames();
  frames[7].color.sharpness = 0.0045;
  EXPECT_THAT(check_blur(frames).sentence, HasSubstr("1 of 100 frames (1.0 %) are blurred"));
  frames[7].color.sharpness = 0.006;
  EXPECT_EQ(check_blur(frames).verdict, Verdict::kGood);
}

TEST(BlurCheck, FindsARecordingOutOfFocusThroughout) {
  auto frames = good_frames();
  for (auto& frame : frames) frame.color.sharpness = 0.002;
  EXPECT_EQ(check_blur(frames).verdict, Verdict::kFault);
}

TEST(ExposureCheck, AloneFindsBlackWhiteAndCoveredPictures) {
  auto frames = good_frames();
  frames[1].color = {3, 2, 0};
  frames[2].color = {250, 20, 0.001};
  frames[3].color = {90, 4, 0};
  for (std::size_t i = 1; i < 4; ++i) frames[i].color_change = 0;
  EXPECT_THAT(check_exposure(frames).sentence, HasSubstr("3 of 100"));
  EXPECT_EQ(check_blur(frames).verdict, Verdict::kGood);
  EXPECT_EQ(check_exposure_jumps(frames).verdict, Verdict::kGood);
  EXPECT_EQ(check_frozen(frames).verdict, Verdict::kGood);
}

TEST(ExposureJumps, AreFoundWhereTheyAreUnusual) {
  auto frames = good_frames();
  for (std::size_t i = 60; i < 100; ++i) frames[i].color.brightness = 150;
  EXPECT_THAT(check_exposure_jumps(frames).sentence, HasSubstr("1 of 100"));
  for (std::size_t i = 0; i < 100; ++i) frames[i].color.brightness = i % 2 == 0 ? 100 : 125;
  EXPECT_EQ(check_exposure_jumps(frames).verdict, Verdict::kGood);
}

TEST(DepthScale, ThatCannotBeIsAFaultWithAProposal) {
  auto frames = good_frames();
  scale_depth(frames, 1.0 / 50);
  const auto finding = check_depth_scale(frames, 50000);
  EXPECT_EQ(finding.verdict, Verdict::kFault);
  EXPECT_THAT(finding.sentence, HasSubstr("with 1000 it would be 2.00 m"));
  EXPECT_THAT(finding.sentence, Not(HasSubstr("with 10000")));
}

TEST(DepthScale, OfTheOtherUsualKindIsFoundBothWays) {
  auto near = good_frames();
  for (auto& frame : near) frame.depth.near_m = 1.5;
  scale_depth(near, 1.0 / 5);
  EXPECT_EQ(check_depth_scale(near, 5000).verdict, Verdict::kHint);
  EXPECT_THAT(check_depth_scale(near, 5000).sentence, HasSubstr("with 1000 it would be 2.00 m"));
  auto far = good_frames();
  scale_depth(far, 5);
  EXPECT_EQ(check_depth_scale(far, 1000).verdict, Verdict::kHint);
  EXPECT_THAT(check_depth_scale(far, 1000).sentence, HasSubstr("with 5000 it would be 2.00 m"));
}

TEST(DepthScale, OfATableCloseByIsGood) {
  auto frames = good_frames();
  for (auto& frame : frames) frame.depth = {0.9, 0.45, 0.7, 0.95, 0.01, 700};
  EXPECT_EQ(check_depth_scale(frames, 1000).verdict, Verdict::kGood);
}

TEST(DepthScale, WithoutAnyMeasurementIsAFault) {
  auto frames = good_frames();
  for (auto& frame : frames) frame.depth = {};
  EXPECT_EQ(check_depth_scale(frames, 1000).verdict, Verdict::kFault);
  EXPECT_EQ(check_depth_share(frames).verdict, Verdict::kFault);
}

TEST(DepthValues, ThatAreOneOrSaturatedAreFound) {
  auto frames = good_frames();
  frames[4].depth.commonest = 0.95;
  EXPECT_THAT(check_depth_values(frames).sentence, HasSubstr("hold one value, 2000"));
  frames = good_frames();
  for (auto& frame : frames) frame.depth.commonest = 0.1;
  EXPECT_EQ(check_depth_values(frames).verdict, Verdict::kGood);
  for (auto& frame : frames) frame.depth.commonest_raw = 65535;
  EXPECT_EQ(check_depth_values(frames).verdict, Verdict::kFault);
}

TEST(DepthFrozen, CountsRepeatedDepth) {
  auto frames = good_frames();
  for (std::size_t i = 0; i < 100; i += 2) frames[i].depth_repeated = true;
  EXPECT_EQ(check_depth_frozen(frames).verdict, Verdict::kFault);
}

}  // namespace
}  // namespace rds::doctor
