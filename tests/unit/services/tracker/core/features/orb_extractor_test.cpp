// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/features/orb_extractor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "common/concurrency/parallel_for.hpp"
#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

cv::Mat wall() {
  cv::Mat gray;
  test::picture_of_wall(Pose::Identity(), 0).color.to_gray(gray);
  return gray;
}

std::vector<Feature> extract(const cv::Mat& gray, const MovableTest& is_movable = {}) {
  OrbExtractor extractor(ExtractionConfig{});
  std::vector<Feature> features;
  extractor.extract(gray, is_movable, features);
  return features;
}

bool same(const Feature& a, const Feature& b) {
  return a.px == b.px && a.angle_rad == b.angle_rad && a.level == b.level && a.descriptor == b.descriptor;
}

TEST(OrbExtractor, FindsTheWantedNumberInsideThePicture) {
  const auto features = extract(wall());
  EXPECT_GT(features.size(), 800U);
  EXPECT_LE(features.size(), 1000U);
  for (const Feature& f : features) {
    EXPECT_TRUE(f.px.x() > 10 && f.px.x() < 310 && f.px.y() > 10 && f.px.y() < 230);
    EXPECT_LT(f.level, 8);
  }
}

TEST(OrbExtractor, GivesTheSameBytesWhateverTheNumberOfThreads) {
  const cv::Mat gray = wall();
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const auto one = extract(gray);
  cv::setNumThreads(4);
  const auto four = extract(gray);
  cv::setNumThreads(threads);
  EXPECT_TRUE(std::ranges::equal(one, four, same));
}

TEST(OrbExtractor, GivesTheSameBytesWithAHelper) {
  concurrency::ParallelFor helper;
  OrbExtractor helped(ExtractionConfig{},
                      [&](std::size_t count, const auto& part) { helper.run(count, part); });
  const auto left = [](const Eigen::Vector2f& px) { return px.x() < 120; };
  std::vector<Feature> features;
  for (int i = 0; i < 5; ++i) {
    helped.extract(wall(), left, features);
    EXPECT_TRUE(std::ranges::equal(features, extract(wall(), left), same));
  }
}

TEST(OrbExtractor, DoesNotRememberThePictureBefore) {
  OrbExtractor extractor(ExtractionConfig{});
  std::vector<Feature> features;
  extractor.extract(cv::Mat(480, 640, CV_8UC1, cv::Scalar(3)), {}, features);
  EXPECT_TRUE(features.empty());
  extractor.extract(wall(), {}, features);
  EXPECT_TRUE(std::ranges::equal(features, extract(wall()), same));
}

TEST(OrbExtractor, AnglesTurnWithThePicture) {
  const cv::Mat gray = wall();
  cv::Mat turned;
  cv::rotate(gray, turned, cv::ROTATE_90_CLOCKWISE);
  const auto upright = extract(gray);
  const auto lying = extract(turned);
  int compared = 0;
  for (const Feature& f : upright) {
    if (f.level != 0) continue;
    const Eigen::Vector2f expected(static_cast<float>(gray.rows - 1) - f.px.y(), f.px.x());
    const auto it = std::ranges::find_if(
        lying, [&](const Feature& g) { return g.level == 0 && (g.px - expected).norm() < 0.01F; });
    if (it == lying.end()) continue;
    ++compared;
    const double turn = static_cast<double>(it->angle_rad - f.angle_rad) - std::numbers::pi / 2;
    EXPECT_NEAR(std::remainder(turn, 2 * std::numbers::pi), 0, 0.02);
    EXPECT_LT(descriptor_distance(f.descriptor, it->descriptor), 80);
  }
  EXPECT_GT(compared, 30);
}

TEST(OrbExtractor, GivesTheBudgetToWhatIsStatic) {
  const auto left = [](const Eigen::Vector2f& px) { return px.x() < 120; };
  const auto features = extract(wall(), left);
  int matchable = 0;
  for (const Feature& f : features) {
    EXPECT_EQ(f.movable, left(f.image_px));
    EXPECT_NE(f.movable, f.matchable);
    matchable += f.matchable ? 1 : 0;
  }
  EXPECT_GT(matchable, 700);
}

TEST(OrbExtractor, LetsMovableFeaturesMatchBeforeItStarves) {
  const auto features = extract(wall(), [](const Eigen::Vector2f&) { return true; });
  EXPECT_GT(features.size(), 700U);
  for (const Feature& f : features) EXPECT_TRUE(f.movable && f.matchable);
}

TEST(OrbExtractor, GivesNothingForPicturesWithoutRoomForAPatch) {
  EXPECT_TRUE(extract(cv::Mat(20, 20, CV_8UC1, cv::Scalar(0))).empty());
  EXPECT_TRUE(extract(cv::Mat(1, 1, CV_8UC1, cv::Scalar(0))).empty());
}

}  // namespace
}  // namespace rds::tracker
