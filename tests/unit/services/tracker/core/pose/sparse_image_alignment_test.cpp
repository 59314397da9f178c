// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/sparse_image_alignment.hpp"

#include <gtest/gtest.h>

#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

constexpr int kLevels = 5;

class SparseImageAlignment : public ::testing::Test {
 protected:
  static ImagePyramid pyramid_of(const image::RgbdFrame& frame) {
    cv::Mat gray;
    frame.color.to_gray(gray);
    return {gray, kLevels};
  }

  /// Points of a grid with their depth.
  static std::vector<SeenPoint> points_of(const image::RgbdFrame& frame, int step) {
    std::vector<SeenPoint> points;
    for (int y = 20; y < 220; y += step)
      for (int x = 20; x < 300; x += step)
        points.push_back(
            {{static_cast<float>(x), static_cast<float>(y)},
             static_cast<double>(frame.depth.at(x, y)) * frame.camera.ray(Eigen::Vector2d(x, y))});
    return points;
  }

  Pose align(const ImagePyramid& picture, const Pose& start = Pose::Identity()) const {
    return align_sparsely(reference, points, picture, frame.camera, start);
  }

  static double error_px(const Pose& found, const Pose& truth) {
    const Eigen::Vector3d p(0.3, 0.2, 2);
    return (test::small_camera().project(found * p) - test::small_camera().project(truth * p)).norm();
  }

  image::RgbdFrame frame = test::picture_of_wall(Pose::Identity(), 0);
  ImagePyramid reference = pyramid_of(frame);
  std::vector<SeenPoint> points = points_of(frame, 16);
  Pose moved = test::pose(0.04, -0.02, 0.03, 0.02);  // 12 px
};

TEST_F(SparseImageAlignment, FindsTheMotion) {
  const ImagePyramid picture = pyramid_of(test::picture_of_wall(moved, 1));
  const Pose truth = moved.inverse();
  ASSERT_GT(error_px(Pose::Identity(), truth), 8);
  EXPECT_LT(error_px(align(picture), truth), 0.3);
}

TEST_F(SparseImageAlignment, AMotionOfItselfIsNone) {
  EXPECT_LT(error_px(align(reference), Pose::Identity()), 0.01);
}

TEST_F(SparseImageAlignment, WhatHidesAThirdOfThePictureDoesNotMatterMuch) {
  image::RgbdFrame hidden = test::picture_of_wall(moved, 1);
  hidden.color.pixels(cv::Rect(0, 0, 107, 240)).setTo(cv::Scalar(40, 200, 90));
  EXPECT_LT(error_px(align(pyramid_of(hidden)), moved.inverse()), 2);
}

/// A wall of little contrast, before which something of much contrast has come.
TEST_F(SparseImageAlignment, FewPointsOfMuchContrastDoNotDrawManyOfLittleAside) {
  const auto pale = [](image::RgbdFrame picture) {
    picture.color.pixels.convertTo(picture.color.pixels, -1, 0.1, 110);
    return pyramid_of(picture);
  };
  const ImagePyramid before = pale(frame);
  image::RgbdFrame hidden = test::picture_of_wall(moved, 1);
  hidden.color.pixels.convertTo(hidden.color.pixels, -1, 0.1, 110);
  hidden.color.pixels(cv::Rect(120, 0, 40, 240)).setTo(cv::Scalar(20, 20, 20));
  const Pose truth = moved.inverse();
  EXPECT_LT(error_px(align_sparsely(before, points, pyramid_of(hidden), frame.camera, truth), truth), 0.5);
}

TEST_F(SparseImageAlignment, ABrighterPictureIsTheSame) {
  image::RgbdFrame brighter = test::picture_of_wall(moved, 1);
  brighter.color.pixels.convertTo(brighter.color.pixels, -1, 0.9, 30);
  EXPECT_LT(error_px(align(pyramid_of(brighter)), moved.inverse()), 0.5);
}

TEST_F(SparseImageAlignment, KeepsWhatApartPixelAndProjectionWere) {
  const Eigen::Vector2f apart(3, -2);
  for (SeenPoint& p : points) p.in_reference += 2 * Eigen::Vector3d(-apart.x() / 300, -apart.y() / 300, 0);
  const ImagePyramid picture = pyramid_of(test::picture_of_wall(moved, 1));
  EXPECT_LT(error_px(align(picture), moved.inverse()), 0.5);
}

TEST_F(SparseImageAlignment, StaysWhereThereIsNothingToCompare) {
  const Pose start = test::pose(0.01, 0.02, 0.03, 0.1);
  points.resize(5);
  EXPECT_TRUE(align(reference, start).isApprox(start, 0));
  points.clear();
  EXPECT_TRUE(align(reference, start).isApprox(start, 0));
}

}  // namespace
}  // namespace rds::tracker
