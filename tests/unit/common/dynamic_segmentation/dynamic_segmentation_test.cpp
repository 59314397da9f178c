// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/dynamic_segmentation.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/common/dynamic_segmentation/small_grid.hpp"

namespace rds::segmentation {
namespace {

using test::small_grid;

constexpr float kWallM = 3;
constexpr float kThingM = 1.5F;
const cv::Rect kThing(60, 30, 30, 60);  // cells
constexpr std::uint16_t kWallsColour = 100;
constexpr std::uint16_t kThingsColour = 500;

/// How far a column of the thing is behind its middle: it is round, as a plane is nobody.
float bulge_m(int column) {
  const float aside = 2 * (static_cast<float>(column) + 0.5F) / static_cast<float>(kThing.width) - 1;
  return 0.2F * (1 - std::sqrt(1 - aside * aside));
}

/// Something in front of a wall, each of its own colour.
PictureCells picture() {
  PictureCells cells{cv::Mat1f(small_grid().size(), kWallM), cv::Mat1b(small_grid().size(), std::uint8_t{0}),
                     cv::Mat1w(small_grid().size(), kWallsColour)};
  for (int column = 0; column < kThing.width; ++column)
    cells.depth_m(kThing).col(column).setTo(kThingM + bulge_m(column));
  cells.colours(kThing).setTo(kThingsColour);
  return cells;
}

/// A box around these cells.
ObjectRegion around(const cv::Rect& cells) {
  const auto cell = static_cast<double>(small_grid().cell_px());
  return {{cell * cells.x, cell * cells.y, cell * cells.br().x, cell * cells.br().y}, 1, 2};
}

/// Shares of the thing's cells and of all others that are movable.
std::pair<double, double> shares(const Segmentation& found) {
  const cv::Mat1b movable(found.log_odds > 0);
  const double all = cv::countNonZero(movable);
  const double things = cv::countNonZero(movable(kThing));
  return {things / kThing.area(), (all - things) / static_cast<double>(movable.total() - kThing.area())};
}

MotionEvidence nothing_moved() {
  return {cv::Mat1b(small_grid().size(), std::uint8_t{0}), cv::Mat1b(small_grid().size(), std::uint8_t{0})};
}

TEST(DynamicSegmentation, WithoutEvidenceNothingIsMovable) {
  EXPECT_EQ(cv::countNonZero(segment(picture(), small_grid(), {}).log_odds > 0), 0);
}

TEST(DynamicSegmentation, ABoxTakesItsThingAndLeavesTheWall) {
  const std::vector boxes{around(kThing + cv::Size(10, 10))};
  const auto [thing, rest] = shares(segment(picture(), small_grid(), {boxes, {}, {}}));
  EXPECT_EQ(thing, 1);
  EXPECT_EQ(rest, 0);
}

TEST(DynamicSegmentation, AThingIsTakenWholeByABoxOfAPartOfIt) {
  const std::vector boxes{around({kThing.x, kThing.y, kThing.width, kThing.height * 2 / 3})};
  const auto [thing, rest] = shares(segment(picture(), small_grid(), {boxes, {}, {}}));
  EXPECT_EQ(thing, 1);
  EXPECT_EQ(rest, 0);
}

TEST(DynamicSegmentation, ColourPartsWhatDepthJoins) {
  PictureCells cells = picture();
  cells.depth_m(cv::Rect(kThing.br().x, kThing.y, 60, kThing.height)).setTo(kThingM);  // a shelf beside
  const std::vector boxes{around(kThing + cv::Size(3, 0))};
  EXPECT_EQ(shares(segment(cells, small_grid(), {boxes, {}, {}})).second, 0);
}

TEST(DynamicSegmentation, WhatHasAppearedNeedsNoBox) {
  MotionEvidence motion = nothing_moved();
  motion.appeared(kThing).setTo(255);
  const auto [thing, rest] = shares(segment(picture(), small_grid(), {{}, motion, {}}));
  EXPECT_EQ(thing, 1);
  EXPECT_EQ(rest, 0);
}

TEST(DynamicSegmentation, StablePointsHoldAThing) {
  PictureCells cells = picture();
  cells.stable(kThing).setTo(255);
  const std::vector boxes{around(kThing)};
  EXPECT_EQ(shares(segment(cells, small_grid(), {boxes, {}, {}})).first, 0);
}

TEST(DynamicSegmentation, WhatWasMovableStaysSoWithoutItsBox) {
  const std::vector boxes{around(kThing)};
  const Segmentation before = segment(picture(), small_grid(), {boxes, {}, {}});
  EXPECT_EQ(shares(segment(picture(), small_grid(), {{}, nothing_moved(), before.presence})).first, 1);
}

TEST(DynamicSegmentation, PresenceFadesToWhatIsKnownOfAnyCell) {
  const EvidenceModel model;
  const float unseen = log_odds_of(model.unseen);
  EXPECT_EQ(lasting_presence(4, 0), 4);
  EXPECT_NEAR(lasting_presence(4, model.lasting_s), unseen + (4 - unseen) / 2.71828F, 1e-4);
  EXPECT_NEAR(lasting_presence(4, 60), unseen, 1e-4);
}

}  // namespace
}  // namespace rds::segmentation
