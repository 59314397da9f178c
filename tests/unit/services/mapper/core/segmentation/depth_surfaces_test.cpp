// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/depth_surfaces.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

TEST(DepthSurfaces, PartAtDepthEdgesAndFollowSlopes) {
  const MapperConfig config;
  KeyframeInput input =
      test::SyntheticKeyframe(0).rectangle({40, 40, 60, 60}, 1.5).rectangle({200, 40, 60, 60}, 1.5);
  for (int x = 120; x < 180; ++x) input.depth.values(cv::Rect(x, 150, 1, 60)).setTo(1.0 + 0.01 * (x - 120));
  const auto record = test::measured(input, config.sampling);
  std::vector<std::uint16_t> surface;
  EXPECT_EQ(find_surfaces(record, surface), 4);
  const auto at = [&](int x_px, int y_px) { return surface[record.grid.index(x_px / 2, y_px / 2)]; };
  EXPECT_EQ(at(10, 10), at(310, 230));  // the wall
  EXPECT_NE(at(70, 70), at(10, 10));
  EXPECT_NE(at(70, 70), at(230, 70));
  EXPECT_EQ(at(126, 180), at(174, 180));  // 48 cm apart, 2 cm a step
  EXPECT_NE(at(150, 180), 0);
}

TEST(DepthSurfaces, AStepIsOfSlantOrOfNoiseWhicheverIsMore) {
  const SurfaceSteps ideal(geometry::depth_noise("ideal").value());
  const SurfaceSteps stereo(geometry::depth_noise("realsense").value());
  EXPECT_EQ(ideal.at(8000), 300);
  EXPECT_EQ(ideal.at(40000), 1200);
  EXPECT_EQ(stereo.at(8000), 300);
  EXPECT_NEAR(stereo.at(40000), 3 * std::sqrt(2) * 0.08 * 16 / (424 * 0.05) * 1e4, 1);
}

TEST(DepthSurfaces, AFewPixelsAreNone) {
  MapperConfig config;
  config.sampling.edge_support = 0;
  const KeyframeInput input = test::SyntheticKeyframe(0).rectangle({100, 100, 4, 4}, 1.5);
  const auto record = test::measured(input, config.sampling);
  std::vector<std::uint16_t> surface;
  EXPECT_EQ(find_surfaces(record, surface), 1);
  EXPECT_EQ(surface[record.grid.index(51, 51)], 0);
}

}  // namespace
}  // namespace rds::mapper
