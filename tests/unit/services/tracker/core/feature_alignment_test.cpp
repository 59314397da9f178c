// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/feature_alignment.hpp"

#include <gtest/gtest.h>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

constexpr int kLevels = 4;

cv::Mat gray_wall() {
  cv::Mat gray;
  test::picture_of_wall(Pose::Identity(), 0).color.to_gray(gray);
  cv::GaussianBlur(gray, gray, {}, 1);  // as a lens does
  return gray;
}

/// A picture that shows `centre` of the wall at `place`, turned and scaled.
struct Moved {
  Moved(const cv::Mat& wall, Eigen::Vector2f centre, Eigen::Vector2f place, const Eigen::Matrix2f& linear) {
    const Eigen::Vector2f shift = place - linear * centre;
    const cv::Matx23f m(linear(0, 0), linear(0, 1), shift.x(), linear(1, 0), linear(1, 1), shift.y());
    cv::warpAffine(wall, image, m, wall.size());
  }
  cv::Mat image;
};

class FeatureAlignment : public ::testing::Test {
 protected:
  /// @return share of corners that were found within `tolerance` px of the truth.
  double found_share(const Eigen::Matrix2f& linear, const Eigen::Vector2f& start_off, float tolerance) {
    int found = 0;
    int tried = 0;
    for (const cv::KeyPoint& corner : corners) {
      const Eigen::Vector2f centre(corner.pt.x, corner.pt.y);
      if ((centre - Eigen::Vector2f(160, 120)).cwiseAbs().maxCoeff() > 60) continue;
      const Eigen::Vector2f place(150.3F, 110.6F);
      const ImagePyramid picture(Moved(wall, centre, place, linear).image, kLevels);
      const auto aligned = align_feature({&reference, centre, linear, 1}, picture, place + start_off, 3);
      ++tried;
      found += aligned && (aligned->image_px - place).norm() < tolerance && aligned->correlation > 0.9F;
    }
    EXPECT_GT(tried, 20);
    return static_cast<double>(found) / tried;
  }

  cv::Mat wall = gray_wall();
  ImagePyramid reference{wall, kLevels};
  std::vector<cv::KeyPoint> corners = [this] {
    std::vector<cv::KeyPoint> found;
    cv::FAST(wall, found, 40, true);
    return found;
  }();
};

TEST_F(FeatureAlignment, FindsAShiftToATenthOfAPixel) {
  EXPECT_GT(found_share(Eigen::Matrix2f::Identity(), {1, -0.7F}, 0.1F), 0.65);
}

TEST_F(FeatureAlignment, KnowsHowThePatchIsTurnedAndScaled) {
  const Eigen::Matrix2f linear = 1.2F * Eigen::Rotation2Df(0.4F).toRotationMatrix();
  EXPECT_GT(found_share(linear, {0.5F, 0.5F}, 0.15F), 0.7);
}

TEST_F(FeatureAlignment, BrightnessAndContrastDoNotMatter) {
  const ImagePyramid picture(wall * 0.6 + 60, kLevels);
  for (const cv::KeyPoint& corner : corners) {
    const Eigen::Vector2f px(corner.pt.x, corner.pt.y);
    const PatchWarp same{&reference, px, Eigen::Matrix2f::Identity(), 1};
    const auto aligned = align_feature(same, picture, px + Eigen::Vector2f(0.6F, -0.5F), 3);
    if (!aligned) continue;
    EXPECT_LT((aligned->image_px - px).norm(), 0.1F);
    EXPECT_GT(aligned->correlation, 0.98F);
  }
}

TEST_F(FeatureAlignment, AnotherPatchDoesNotCorrelate) {
  const Eigen::Matrix2f same = Eigen::Matrix2f::Identity();
  for (float x = 60; x < 260; x += 20) {
    const auto aligned = align_feature({&reference, {x, 120}, same, 1}, reference, {x + 10, 90}, 3);
    if (aligned) {
      EXPECT_LT(aligned->correlation, 0.9F) << x;
    }
  }
}

TEST_F(FeatureAlignment, FindsNothingWithoutACorner) {
  const ImagePyramid flat(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)), kLevels);
  EXPECT_FALSE(align_feature({&flat, {160, 120}, Eigen::Matrix2f::Identity(), 1}, flat, {160, 120}, 3));
}

TEST_F(FeatureAlignment, FindsNothingOutsideOrWithImpossibleWarps) {
  const Eigen::Matrix2f same = Eigen::Matrix2f::Identity();
  EXPECT_FALSE(align_feature({&reference, {1, 120}, same, 1}, reference, {1, 120}, 3));
  EXPECT_FALSE(align_feature({&reference, {160, 120}, same, 1}, reference, {400, 120}, 3));
  EXPECT_FALSE(align_feature({&reference, {160, 120}, Eigen::Matrix2f::Zero(), 1}, reference, {160, 120}, 3));
  EXPECT_FALSE(align_feature({&reference, {160, 120}, 9 * same, 1}, reference, {160, 120}, 3));
  const Eigen::Matrix2f none = Eigen::Matrix2f::Constant(std::nanf(""));
  EXPECT_FALSE(align_feature({&reference, {160, 120}, none, 1}, reference, {160, 120}, 3));
}

}  // namespace
}  // namespace rds::tracker
