// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/feature_alignment.hpp"

#include <gtest/gtest.h>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

constexpr int kLevels = 4;

/// What a camera with a lens sees of the wall; both pictures of a comparison are made by this.
cv::Mat gray_wall(const Pose& map_from_camera) {
  cv::Mat gray;
  test::picture_of_wall(map_from_camera, 0).color.to_gray(gray);
  cv::GaussianBlur(gray, gray, {}, 1);
  return gray;
}

struct Found {
  int tried = 0;
  int aligned = 0;  // and alike
  int exact = 0;    // of these
};

class FeatureAlignment : public ::testing::Test {
 protected:
  FeatureAlignment() {
    std::vector<cv::KeyPoint> found;
    cv::FAST(wall, found, 40, true);
    for (const cv::KeyPoint& k : found)
      if (std::abs(k.pt.x - 160) < 80 && std::abs(k.pt.y - 120) < 50) corners.emplace_back(k.pt.x, k.pt.y);
  }

  /// Looks for every corner in `picture`, starting `off` from where `place_of` says it is.
  template <class PlaceOf>
  Found find_all(const cv::Mat& picture, const Eigen::Matrix2f& linear, PlaceOf place_of, float tolerance_px,
                 const Eigen::Vector2f& off) {
    const ImagePyramid images(picture, kLevels);
    Found result;
    for (const Eigen::Vector2f& corner : corners) {
      const Eigen::Vector2f place = place_of(corner);
      const auto aligned = align_feature({&reference, corner, linear, 1}, images, place + off, 3);
      ++result.tried;
      if (!aligned || aligned->correlation < 0.9F) continue;
      ++result.aligned;
      result.exact += (aligned->image_px - place).norm() < tolerance_px ? 1 : 0;
    }
    EXPECT_GT(result.tried, 40);
    return result;
  }

  cv::Mat wall = gray_wall(Pose::Identity());
  ImagePyramid reference{wall, kLevels};
  std::vector<Eigen::Vector2f> corners;
};

const Eigen::Matrix2f kSame = Eigen::Matrix2f::Identity();

TEST_F(FeatureAlignment, FindsAShiftToATenthOfAPixel) {
  const Eigen::Vector2f shift(3.3F, -2.6F);  // px, by moving the camera in front of a wall 2 m away
  const cv::Mat moved = gray_wall(test::pose(-3.3 * 2 / 300, 2.6 * 2 / 300, 0));
  const Found found = find_all(
      moved, kSame, [&](const Eigen::Vector2f& c) { return Eigen::Vector2f(c + shift); }, 0.1F, {1, -0.7F});
  EXPECT_GT(found.aligned, 0.8 * found.tried);
  EXPECT_GT(found.exact, 0.8 * found.aligned);
}

TEST_F(FeatureAlignment, KnowsHowThePatchIsTurnedAndScaled) {
  const Eigen::Matrix2f linear = 1.2F * Eigen::Rotation2Df(0.4F).toRotationMatrix();
  const Eigen::Vector2f centre(160, 120);
  const auto place_of = [&](const Eigen::Vector2f& c) {
    return Eigen::Vector2f(centre + linear * (c - centre));
  };
  const Eigen::Vector2f shift = centre - linear * centre;
  cv::Mat turned;
  cv::warpAffine(wall, turned,
                 cv::Matx23f(linear(0, 0), linear(0, 1), shift.x(), linear(1, 0), linear(1, 1), shift.y()),
                 wall.size());
  const Found found = find_all(turned, linear, place_of, 0.2F, {0.5F, 0.5F});
  EXPECT_GT(found.aligned, 0.8 * found.tried);
  EXPECT_GT(found.exact, 0.8 * found.aligned);
  EXPECT_LT(find_all(turned, kSame, place_of, 0.2F, {0.5F, 0.5F}).exact, 0.3 * found.exact);
}

TEST_F(FeatureAlignment, BrightnessAndContrastDoNotMatter) {
  const Found found =
      find_all(wall * 0.6 + 60, kSame, [](const Eigen::Vector2f& c) { return c; }, 0.1F, {0.6F, -0.5F});
  EXPECT_GT(found.aligned, 0.8 * found.tried);
  EXPECT_GT(found.exact, 0.95 * found.aligned);
}

TEST_F(FeatureAlignment, AnotherPatchDoesNotCorrelate) {
  const Found elsewhere = find_all(
      wall, kSame, [](const Eigen::Vector2f& c) { return Eigen::Vector2f(320 - c.x(), 240 - c.y()); }, 0.1F,
      {0, 0});
  EXPECT_LT(elsewhere.aligned, 0.1 * elsewhere.tried);
}

TEST_F(FeatureAlignment, FindsNothingWithoutACorner) {
  const ImagePyramid flat(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)), kLevels);
  EXPECT_FALSE(align_feature({&flat, {160, 120}, kSame, 1}, flat, {160, 120}, 3));
}

TEST_F(FeatureAlignment, FindsNothingOutsideOrWithImpossibleWarps) {
  const Eigen::Vector2f corner = corners.front();
  ASSERT_TRUE(align_feature({&reference, corner, kSame, 1}, reference, corner, 3));
  EXPECT_FALSE(align_feature({&reference, {1, 120}, kSame, 1}, reference, corner, 3));
  EXPECT_FALSE(align_feature({&reference, corner, kSame, 1}, reference, {400, 120}, 3));
  EXPECT_FALSE(align_feature({&reference, corner, Eigen::Matrix2f::Zero(), 1}, reference, corner, 3));
  EXPECT_FALSE(align_feature({&reference, corner, 9 * kSame, 1}, reference, corner, 3));
  const Eigen::Matrix2f none = Eigen::Matrix2f::Constant(std::nanf(""));
  EXPECT_FALSE(align_feature({&reference, corner, none, 1}, reference, corner, 3));
}

}  // namespace
}  // namespace rds::tracker
