// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/box_evidence.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/dynamic_segmentation/small_grid.hpp"

namespace rds::segmentation {
namespace {

using test::small_grid;

const ObjectRegion kBox{{80, 60, 160, 180}, 1.5F, 2.5F};

/// Cells 3 m away, those of the box at @p object_m.
cv::Mat1f object_at(float object_m) {
  cv::Mat1f depth_m(small_grid().size(), 3.0F);
  depth_m(cells_of(kBox.box_px, small_grid())).setTo(object_m);
  return depth_m;
}

cv::Mat1f by(const cv::Mat1f& depth_m, std::vector<ObjectRegion> boxes) {
  return box_log_odds(depth_m, small_grid(), boxes, EvidenceModel());
}

const EvidenceModel kModel;
const float kUnseen = log_odds_of(kModel.unseen);
const float kFilled = log_odds_of(kModel.filled);

TEST(BoxEvidence, OutsideBoxesCellsAreUnseen) {
  const cv::Mat1f found = by(object_at(2), {kBox});
  EXPECT_FLOAT_EQ(found(0, 0), kUnseen);
  EXPECT_EQ(cv::countNonZero(by(object_at(2), {}) != kUnseen), 0);
}

TEST(BoxEvidence, InABoxItFallsWithTheDistanceFromTheObject) {
  cv::Mat1f depth_m = object_at(1.9F);
  const cv::Point corner = cells_of(kBox.box_px, small_grid()).tl();
  depth_m(corner) = 1.9F + kBox.sigma_m;
  depth_m(corner + cv::Point(1, 0)) = 3;
  const cv::Mat1f found = by(depth_m, {kBox});
  EXPECT_FLOAT_EQ(found(corner + cv::Point(5, 5)), kFilled) << "at the object's own depth, not its limits'";
  EXPECT_LT(found(corner), kFilled);
  EXPECT_GT(found(corner), found(corner + cv::Point(1, 0)));
  EXPECT_NEAR(found(corner + cv::Point(1, 0)), kUnseen, 0.01);
}

TEST(BoxEvidence, WhatIsBeyondTheLimitsDoesNotMoveTheObject) {
  cv::Mat1f depth_m = object_at(3);
  const cv::Rect cells = cells_of(kBox.box_px, small_grid());
  depth_m(cv::Rect(cells.tl(), cv::Size(5, cells.height))).setTo(2);
  EXPECT_FLOAT_EQ(by(depth_m, {kBox})(cells.tl()), kFilled) << "most of the box shows the wall";
}

TEST(BoxEvidence, WithoutDepthOnlyTheBoxCounts) {
  const cv::Mat1f found = by(cv::Mat1f(small_grid().size(), 0.0F), {kBox});
  EXPECT_FLOAT_EQ(found(cells_of(kBox.box_px, small_grid()).tl()), kFilled);
}

TEST(BoxEvidence, OfSeveralBoxesTheOneThatSaysMostCounts) {
  const ObjectRegion far{kBox.box_px, 2.8F, 3.2F};
  const cv::Mat1f depth_m = object_at(2);
  EXPECT_EQ(cv::norm(by(depth_m, {kBox}), cv::max(by(depth_m, {kBox}), by(depth_m, {far}))), 0);
  EXPECT_EQ(cv::norm(by(depth_m, {kBox, far}), by(depth_m, {far, kBox})), 0);
}

TEST(BoxEvidence, ABoxThatLeavesThePictureIsCut) {
  const cv::Rect cells = cells_of({-50, 200, 40, 900}, small_grid());
  EXPECT_EQ(cells.x, 0);
  EXPECT_EQ(cells.br().y, small_grid().size().height);
  EXPECT_TRUE(cells_of({400, 0, 500, 100}, small_grid()).empty());
}

}  // namespace
}  // namespace rds::segmentation
