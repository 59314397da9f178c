// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/picture/map_picture.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "services/mapper/core/octree/label_table.hpp"

namespace rds::tools {
namespace {

int count_near(const cv::Mat& picture, const mapper::Rgb& rgb) {
  const cv::Scalar bgr(rgb[2], rgb[1], rgb[0]);
  cv::Mat mask;
  cv::inRange(picture, bgr - cv::Scalar::all(25), bgr + cv::Scalar::all(25), mask);
  return cv::countNonZero(mask);
}

PictureOptions small() {
  PictureOptions options;
  options.width = 640;
  options.height = 400;
  return options;
}

TEST(MapPicture, ShowsLabelledVoxelsInTheirColour) {
  octomap::ColorOcTree tree(0.05);
  const auto color = mapper::label_color("chair");
  for (float x = 0.025F; x < 1; x += 0.05F)
    for (float z = 1.025F; z < 2; z += 0.05F) {
      tree.updateNode(x, 0.525F, z, true);
      tree.setNodeColor(x, 0.525F, z, color[0], color[1], color[2]);
    }
  MapScene scene{tree, {"", "chair", "bottle"}, {}, {{0.5, -0.5, 0}, {0.6, -0.5, 0}}};
  scene.objects.push_back({"chair", {geometry::Pose(Eigen::Translation3d(0.5, 0.25, 1.5)), {1, 0.5, 1}}});
  const auto picture = render_map(scene, small());
  EXPECT_EQ(picture.size(), cv::Size(640, 400));
  EXPECT_GT(count_near(picture, color), 4000);
  EXPECT_EQ(count_near(picture, mapper::label_color("bottle")), 0);
}

TEST(MapPicture, SaysThatAMapIsEmpty) {
  const octomap::ColorOcTree tree(0.05);
  const auto picture = render_map({tree, {}, {}, {}}, small());
  EXPECT_EQ(picture.size(), cv::Size(640, 400));
  EXPECT_LT(cv::mean(picture)[0], 255);
}

TEST(MapPicture, PointsThatAreNotFiniteDoNoHarm) {
  octomap::ColorOcTree tree(0.05);
  tree.updateNode(0.5F, 0.5F, 0.5F, true);
  MapScene scene{tree, {}, {}, {{NAN, 0, 0}, {1e12, 0, 0}, {0, 0, 0}}};
  scene.objects.push_back(
      {"chair", {geometry::Pose(Eigen::Translation3d(NAN, NAN, NAN)), {1e30, 1e30, 1e30}}});
  EXPECT_NO_THROW(render_map(scene, small()));
}

}  // namespace
}  // namespace rds::tools
