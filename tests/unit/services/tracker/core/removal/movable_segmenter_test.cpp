// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/removal/movable_segmenter.hpp"

#include <gtest/gtest.h>

#include "tests/unit/services/tracker/core/removal/removal_scene.hpp"

namespace rds::tracker {
namespace {

using test::compare;
using test::region_of;
using test::room;
using test::Somebody;
using segmentation::ObjectRegion;
using segmentation::PictureCells;

constexpr std::int64_t kFrameNs = 100'000'000;

class MovableSegmenting : public testing::Test {
 protected:
  static MovableMask look(MovableSegmenter& segmenter, const image::RgbdFrame& picture,
                          const std::vector<ObjectRegion>& regions) {
    segmenter.set_picture(picture);
    segmenter.detect_motion(Pose::Identity());
    MovableMask mask = segmenter.segment(regions, {});
    segmenter.set_pose(Pose::Identity(), true);
    return mask;
  }
  MovableMask look(const image::RgbdFrame& picture, const std::vector<ObjectRegion>& regions = {}) {
    return look(segmenter, picture, regions);
  }

  RemovalConfig config;
  MovableSegmenter segmenter{config, DepthConfig{}};
};

TEST_F(MovableSegmenting, CutsSomebodyOutOfHisBox) {
  const Somebody somebody{0.2, 1.8};
  const image::RgbdFrame picture = room(somebody);
  const auto marked = compare(look(picture, {region_of(somebody, 10)}), picture);
  EXPECT_GT(marked.of_somebody, 0.97);
  EXPECT_LT(marked.of_the_rest, 0.05) << "a rim, and not the floor and the wall that the box shows";
}

TEST_F(MovableSegmenting, ReachesOutOfABoxThatLagsBehind) {
  const Somebody somebody{0.2, 1.8};
  const image::RgbdFrame picture = room(somebody);
  const Somebody expected{somebody.x_m - 0.15, somebody.z_m};
  EXPECT_GT(compare(look(picture, {region_of(expected)}), picture).of_somebody, 0.85)
      << "the box alone holds four fifths of him, at their depth";
}

TEST_F(MovableSegmenting, AWallInABoxIsNobody) {
  const ObjectRegion region{{60, 20, 200, 200}, 2.7F, 3.3F};
  EXPECT_LT(compare(look(room(), {region}), room()).of_the_rest, 0.02);
}

TEST_F(MovableSegmenting, NoBoxesNothing) {
  EXPECT_FALSE(look(room({0.2, 1.8})).any());
}

TEST_F(MovableSegmenting, WholeBoxesIfAskedFor) {
  config.method = "box";
  segmenter = MovableSegmenter(config, DepthConfig{});
  const MovableMask mask = look(room(), {{{60, 20, 200, 200}, 0, 1}});
  EXPECT_TRUE(mask.covers({61, 21}));
  EXPECT_TRUE(mask.covers({199, 199}));
  EXPECT_FALSE(mask.covers({57, 21}));
}

TEST_F(MovableSegmenting, NothingIfSwitchedOff) {
  config.method = "off";
  segmenter = MovableSegmenter(config, DepthConfig{});
  EXPECT_FALSE(look(room({0.2, 1.8}), {region_of({0.2, 1.8})}).any());
}

TEST_F(MovableSegmenting, SeesWhoeverEntersWithoutAnyBox) {
  for (int i = 0; i < 8; ++i) EXPECT_FALSE(look(room({}, i * kFrameNs)).any());
  const image::RgbdFrame entered = room({-0.3, 1.8}, 8 * kFrameNs);
  const auto marked = compare(look(entered), entered);
  EXPECT_GT(marked.of_somebody, 0.9);
  EXPECT_LT(marked.of_the_rest, 0.05);
}

TEST_F(MovableSegmenting, WithoutMotionOnlyBoxesCount) {
  config.motion = false;
  segmenter = MovableSegmenter(config, DepthConfig{});
  for (int i = 0; i < 8; ++i) look(room({}, i * kFrameNs));
  EXPECT_FALSE(look(room({-0.3, 1.8}, 8 * kFrameNs)).any());
}

TEST_F(MovableSegmenting, CarriesWhatLostItsBoxForAWhile) {
  const Somebody somebody{0.2, 1.8};
  look(room(somebody), {region_of(somebody)});
  std::vector<double> kept;
  for (int i = 1; i <= 9; ++i) {
    const image::RgbdFrame picture = room(somebody, i * kFrameNs);
    kept.push_back(compare(look(picture), picture).of_somebody);
  }
  EXPECT_GT(kept[0], 0.95);
  EXPECT_GT(kept[3], 0.8);
  EXPECT_EQ(kept.back(), 0) << "it fades";
}

TEST_F(MovableSegmenting, APoseThatIsWrongShowsNoMotion) {
  for (int i = 0; i < 8; ++i) look(room({}, i * kFrameNs));
  const Pose wrong = test::pose(0, 0, -0.8);
  segmenter.set_picture(room({}, 8 * kFrameNs));
  segmenter.detect_motion(wrong);
  EXPECT_FALSE(segmenter.segment({}, {}).any());
}

TEST_F(MovableSegmenting, WhatHasAlwaysBeenThereStays) {
  const Somebody shelf{0.2, 1.8};
  const image::RgbdFrame picture = room(shelf);
  std::vector<Eigen::Vector3f> stable;
  for (int y = 0; y < picture.camera.height; y += 4)
    for (int x = 0; x < picture.camera.width; x += 4)
      if (test::shows(picture, x, y))
        stable.push_back(picture.depth.at(x, y) *
                         picture.camera.ray({static_cast<double>(x), static_cast<double>(y)}).cast<float>());
  segmenter.set_picture(picture);
  const MovableMask mask = segmenter.segment(std::vector{region_of(shelf)}, stable);
  EXPECT_LT(compare(mask, picture).of_somebody, 0.1);
}

TEST_F(MovableSegmenting, LateBoxesAreCutFromThePictureTheyBelongTo) {
  const Somebody somebody{0.2, 1.8};
  const image::RgbdFrame picture = room(somebody);
  look(picture);
  const PictureCells cells = segmenter.latest();
  look(room({}, kFrameNs));
  const auto marked = compare(segmenter.segment_keyframe(cells, std::vector{region_of(somebody)}), picture);
  EXPECT_GT(marked.of_somebody, 0.95);
  EXPECT_LT(marked.of_the_rest, 0.05);
  EXPECT_FALSE(segmenter.segment_keyframe({cv::Mat1f(3, 3), {}, {}}, std::vector{region_of(somebody)}).any())
      << "of another camera";
}

TEST_F(MovableSegmenting, APictureWithoutDepthHidesTheWholeBox) {
  image::RgbdFrame blind = room();
  blind.depth = image::empty_depth({blind.camera.width, blind.camera.height});
  const MovableMask mask = look(blind, {{{60, 20, 200, 200}, 1, 2}});
  EXPECT_TRUE(mask.covers({100, 100}));
  EXPECT_FALSE(mask.covers({250, 100}));
}

TEST_F(MovableSegmenting, SameCallsSameMask) {
  const Somebody somebody{0.2, 1.8};
  MovableSegmenter other(config, DepthConfig{});
  for (int i = 0; i < 5; ++i) {
    const image::RgbdFrame picture = room({0.1 * i, 1.8}, i * kFrameNs);
    const std::vector<ObjectRegion> regions{region_of(somebody, 5)};
    const MovableMask first = look(picture, regions);
    const MovableMask second = look(other, picture, regions);
    EXPECT_EQ(cv::countNonZero(first.cells() != second.cells()), 0);
  }
}

}  // namespace
}  // namespace rds::tracker
