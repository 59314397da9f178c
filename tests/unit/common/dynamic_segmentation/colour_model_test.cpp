// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/colour_model.hpp"

#include <gtest/gtest.h>

namespace rds::segmentation {
namespace {

const cv::Size kCells(16, 12);
constexpr int kCellPx = 4;
const cv::Scalar kRed(200, 30, 30);
const cv::Scalar kGrey(120, 120, 120);

/// Left half and right half of these colours (red, green, blue).
image::ColorImage halves(const cv::Scalar& left, const cv::Scalar& right) {
  image::ColorImage picture;
  picture.order = image::ChannelOrder::kRgb;
  picture.pixels = cv::Mat(kCells * kCellPx, CV_8UC3, right);
  picture.pixels.colRange(0, picture.pixels.cols / 2).setTo(left);
  return picture;
}

ColourCells cells_of(const image::ColorImage& picture) {
  return colours_in_cells(picture, kCells, kCellPx);
}

/// Log-odds that say of the first columns that they are movable.
cv::Mat1f movable_until(int column) {
  cv::Mat1f log_odds(kCells, -1.0F);
  log_odds.colRange(0, column).setTo(1);
  return log_odds;
}

TEST(ColourModel, TheOrderOfChannelsDoesNotMatter) {
  image::ColorImage swapped = halves({30, 30, 200}, kGrey);
  swapped.order = image::ChannelOrder::kBgr;
  EXPECT_EQ(cv::norm(cells_of(swapped), cells_of(halves(kRed, kGrey))), 0);
}

TEST(ColourModel, ACellIsTheMeanOfItsPixels) {
  image::ColorImage striped = halves(kGrey, kGrey);
  for (int row = 0; row < striped.pixels.rows; ++row)
    striped.pixels.row(row).setTo(row % 4 < 2 ? cv::Scalar(100, 100, 100) : cv::Scalar(140, 140, 140));
  EXPECT_EQ(cv::norm(cells_of(striped), cells_of(halves(kGrey, kGrey))), 0);
}

TEST(ColourModel, WhatHasTheColourOfMovableThingsIsLikelierMovable) {
  const ColourCells colours = cells_of(halves(kRed, kGrey));
  const cv::Mat1f ratio = colour_ratio(colours, movable_until(kCells.width / 4), EvidenceModel());
  EXPECT_GT(ratio(3, kCells.width / 2 - 1), 0) << "red, and not yet taken for movable";
  EXPECT_LT(ratio(3, kCells.width - 1), 0);
}

TEST(ColourModel, SaysNothingWhereBothSidesHaveTheSameColours) {
  const ColourCells colours = cells_of(halves(kGrey, kGrey));
  const cv::Mat1f ratio = colour_ratio(colours, movable_until(kCells.width / 2), EvidenceModel());
  EXPECT_NEAR(cv::norm(ratio, cv::NORM_INF), 0, 1e-3);
}

TEST(ColourModel, SaysLittleWhileNothingIsTakenForMovable) {
  const ColourCells colours = cells_of(halves(kRed, kGrey));
  const cv::Mat1f ratio = colour_ratio(colours, movable_until(0), EvidenceModel());
  EXPECT_LT(ratio(0, 0), 0) << "both colours have been seen on what is static";
  EXPECT_LT(ratio(0, kCells.width - 1), 0);
}

}  // namespace
}  // namespace rds::segmentation
