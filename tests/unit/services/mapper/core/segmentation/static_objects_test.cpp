// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/static_objects.hpp"

#include <gtest/gtest.h>

#include "services/mapper/core/segmentation/keyframe_cells.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::SyntheticKeyframe;

/// Below the horizon a level surface this far under the camera [m], above it the wall.
SyntheticKeyframe over_surface(double depth_below_m) {
  SyntheticKeyframe keyframe(0);
  for (int y = 125; y < 240; ++y) {
    const double z = depth_below_m * 290 / (y - 119.5);
    if (z < 3) keyframe.rectangle({0, y, 320, 1}, z);
  }
  return keyframe;
}

StaticObject object_of(const KeyframeInput& input, const cv::Rect& px, float depth_m) {
  const auto record = test::measured(input, SamplingConfig{});
  const LabelledBox box{"chair", 0.9F,    {double(px.x), double(px.y), double(px.br().x), double(px.br().y)},
                        {},      depth_m, false};
  const LabelledBox* boxes = &box;
  return segment_static(record, colours_in_cells(record), {&boxes, 1}).front();
}

/// Pixels of the full picture that a box's object has, as a mask of the sampled ones.
std::vector<bool> object_in(const KeyframeInput& input, const cv::Rect& px, float depth_m) {
  std::vector<bool> mask(input.depth.values.total() / 4, false);
  for (const auto i : object_of(input, px, depth_m).pixels) mask[i] = true;
  return mask;
}

bool at(const std::vector<bool>& mask, int x_px, int y_px) {
  return mask[static_cast<std::size_t>(y_px / 2 * 160 + x_px / 2)];
}

TEST(StaticObject, TheFloorBetweenItsLegsIsNotItsOwn) {
  const auto keyframe = over_surface(0.8)
                            .rectangle({120, 100, 80, 60}, 2.0)
                            .rectangle({120, 160, 12, 70}, 2.0)
                            .rectangle({188, 160, 12, 70}, 2.0);
  const auto mask = object_in(keyframe, {120, 100, 80, 130}, 2.0F);
  EXPECT_TRUE(at(mask, 160, 130));
  EXPECT_TRUE(at(mask, 126, 200));
  EXPECT_TRUE(at(mask, 194, 200));
  for (int y = 166; y < 230; ++y) EXPECT_FALSE(at(mask, 160, y)) << y;
}

TEST(StaticObject, ATableTopBehindAChairDoesNotCutIt) {
  const auto keyframe = over_surface(0.3).rectangle({120, 60, 80, 170}, 1.0);
  const auto mask = object_in(keyframe, {120, 60, 80, 170}, 1.0F);
  for (int y = 64; y < 226; ++y) EXPECT_TRUE(at(mask, 160, y)) << y;
}

TEST(StaticObject, ASeatThatReachesForwardBelongsToItsBack) {
  SyntheticKeyframe keyframe(0);
  for (int y = 60; y < 180; ++y)
    for (int x = 120; x < 200; ++x)  // round: no plane
      keyframe.rectangle({x, y, 1, 1},
                         2.05 - 0.05 * std::cos((x - 160) / 12.0) - 0.01 * std::max(0, y - 140));
  const auto mask = object_in(keyframe, {120, 60, 80, 120}, 2.0F);
  EXPECT_TRUE(at(mask, 160, 100));
  EXPECT_TRUE(at(mask, 160, 174));
}

TEST(StaticObject, WhatMostlyStandsBesideItsBoxIsNotItsOwn) {
  SyntheticKeyframe keyframe(0);
  keyframe.rectangle({120, 60, 60, 100}, 2.0);
  for (int x = 190; x < 300; ++x)
    keyframe.rectangle({x, 60, 1, 100}, 2.1 + 0.1 * std::cos((x - 245) / 15.0));  // round: no plane
  const auto mask = object_in(keyframe, {120, 60, 85, 100}, 2.0F);
  EXPECT_TRUE(at(mask, 150, 110));
  EXPECT_FALSE(at(mask, 198, 110));
}

TEST(StaticObject, APosterIsFlushWithItsWallAScreenBeforeItIsNot) {
  const cv::Rect px(120, 60, 80, 60);
  EXPECT_TRUE(object_of(SyntheticKeyframe(0).rectangle(px, 2.97), px, 2.97F).flush);
  EXPECT_FALSE(object_of(SyntheticKeyframe(0).rectangle(px, 2.8), px, 2.8F).flush);
}

}  // namespace
}  // namespace rds::mapper
