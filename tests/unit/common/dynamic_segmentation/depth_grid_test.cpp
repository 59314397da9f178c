// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/depth_grid.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/services/tracker/core/removal/removal_scene.hpp"

namespace rds::tracker {
namespace {

geometry::CameraModel distorted(int width, int height) {
  return {width, height, 0.82 * width, 0.82 * width, width / 2.0, height / 2.0, {0.26, -0.95, 0, 0, 1.16}};
}

TEST(DepthGrid, HasSome160CellsAcrossWhateverTheResolution) {
  for (const auto& [width, height] : {std::pair{320, 240}, {640, 480}, {1280, 720}, {848, 480}}) {
    const segmentation::GridGeometry grid(distorted(width, height));
    EXPECT_NEAR(grid.size().width, 160, 20) << width;
    EXPECT_GE(grid.size().width * grid.cell_px(), width);
    EXPECT_GE(grid.size().height * grid.cell_px(), height);
  }
}

TEST(DepthGrid, ARayComesBackToItsCell) {
  const segmentation::GridGeometry grid(distorted(640, 480));
  for (int r = 0; r < grid.size().height; ++r)
    for (int c = 0; c < grid.size().width; ++c) {
      const cv::Point cell = grid.cell_of(2.5F * grid.ray(c, r));
      EXPECT_LE(std::max(std::abs(cell.x - c), std::abs(cell.y - r)), 1) << c << " " << r;
    }
}

TEST(DepthGrid, WhatIsOutsideThePictureOrBehindHasNoCell) {
  const segmentation::GridGeometry grid(distorted(640, 480));
  EXPECT_EQ(grid.cell_of({5, 0, 1}).x, -1);
  EXPECT_EQ(grid.cell_of({0, -5, 1}).x, -1);
  EXPECT_EQ(grid.cell_of({0, 0, -1}).x, -1);
  EXPECT_EQ(grid.cell_of({0, 0, std::numeric_limits<float>::quiet_NaN()}).x, -1);
}

TEST(DepthGrid, TakesTheNearestOfACellAndNothingThatIsNoMeasurement) {
  const geometry::CameraModel camera = distorted(640, 480);
  const segmentation::GridGeometry grid(camera);
  cv::Mat1w millimetres(480, 640, std::uint16_t{3000});
  millimetres(cv::Rect(0, 0, 4, 4)).setTo(0);
  millimetres(cv::Rect(4, 0, 2, 4)).setTo(1500);
  millimetres(cv::Rect(8, 0, 4, 4)).setTo(9000);
  const cv::Mat1f cells = segmentation::depth_in_cells({millimetres, 0.001F, nullptr}, grid, 8);
  EXPECT_EQ(cells(0, 0), 0);
  EXPECT_FLOAT_EQ(cells(0, 1), 1.5F);
  EXPECT_EQ(cells(0, 2), 0) << "beyond max_depth_m";
  EXPECT_FLOAT_EQ(cells(0, 3), 3);
  cv::Mat1f metres(480, 640, std::numeric_limits<float>::quiet_NaN());
  metres.row(1).setTo(2);
  const cv::Mat1f again = segmentation::depth_in_cells({metres, 1, nullptr}, grid, 8);
  EXPECT_FLOAT_EQ(again(0, 0), 2);
  EXPECT_EQ(again(1, 0), 0);
}

}  // namespace
}  // namespace rds::tracker
