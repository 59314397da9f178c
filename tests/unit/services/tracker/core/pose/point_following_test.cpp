// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/point_following.hpp"

#include <atomic>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include "common/concurrency/parallel_for.hpp"
#include "services/tracker/core/features/orb_extractor.hpp"
#include "services/tracker/core/mapping/map_building.hpp"
#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

constexpr int kLevels = 5;

ImagePyramid pyramid_of(const image::RgbdFrame& frame) {
  cv::Mat gray;
  frame.color.to_gray(gray);
  return {gray, kLevels};
}

void expect_same(const FollowedPoints& a, const FollowedPoints& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.looked_for, b.looked_for);
  ASSERT_EQ(a.features.size(), b.features.size());
  for (std::size_t i = 0; i < a.features.size(); ++i)
    EXPECT_EQ(a.features[i].image_px, b.features[i].image_px);
}

/// A map of one keyframe that saw a wall, and a view of the wall from elsewhere.
class PointFollowing : public ::testing::Test {
 protected:
  PointFollowing() {
    const image::RgbdFrame wall = test::picture_of_wall(Pose::Identity(), 0);
    const auto seen = std::make_shared<const ImagePyramid>(pyramid_of(wall));
    std::vector<Feature> features;
    OrbExtractor(extraction).extract(seen->level(0), {}, features);
    complete_features(wall.camera, wall.depth, 8, features);
    TrackedFrame frame;
    frame.features = std::make_shared<const FeatureSet>(wall.camera, std::move(features));
    frame.clear_matches();
    insert_keyframe(map, frame, DepthConfig{}).images = seen;
    map.points().for_each([&](const MapPoint& p) { all.push_back(p.id); });
  }

  FollowedPoints follow(const MovableMask& movable = {}, const Executor& executor = execute_serially) {
    return search().find(movable, executor);
  }

  PointSearch search() {
    return {map,
            all,
            {picture, images, camera.inverse(), {}},
            ObservationModel(picture.camera),
            pyramid,
            wanted};
  }

  double offset_px(const FollowedPoints& followed, std::size_t i) {
    const Eigen::Vector3d p = camera.inverse() * map.point(followed.points[i])->position;
    return (picture.camera.project(p) - followed.features[i].image_px.cast<double>()).norm();
  }

  ExtractionConfig extraction{.features = 400, .levels = 4};
  ScalePyramid pyramid{4, 1.2};
  int wanted = 400;
  SlamMap map{pyramid};
  std::vector<PointId> all;
  Pose camera = test::pose(0.1, -0.05, 0.1, 0.05);
  image::RgbdFrame picture = test::picture_of_wall(camera, 1);
  ImagePyramid images = pyramid_of(picture);
};

TEST_F(PointFollowing, FindsMostPointsToAFractionOfAPixel) {
  const FollowedPoints followed = follow();
  ASSERT_GT(followed.points.size(), 150U);
  EXPECT_GT(static_cast<double>(followed.points.size()),
            0.7 * static_cast<double>(followed.looked_for.size()));
  std::size_t exact = 0;
  for (std::size_t i = 0; i < followed.points.size(); ++i) exact += offset_px(followed, i) < 0.5 ? 1 : 0;
  EXPECT_GT(static_cast<double>(exact), 0.9 * static_cast<double>(followed.points.size()));
}

TEST_F(PointFollowing, CorrectsAPoseThatIsTwoPixelsOff) {
  const Pose truth = camera;
  camera = camera * test::pose(0.01, 0.005, 0);
  const FollowedPoints followed = follow();
  camera = truth;
  ASSERT_GT(followed.points.size(), 150U);
  std::size_t exact = 0;
  for (std::size_t i = 0; i < followed.points.size(); ++i) exact += offset_px(followed, i) < 0.5 ? 1 : 0;
  EXPECT_GT(static_cast<double>(exact), 0.8 * static_cast<double>(followed.points.size()));
}

TEST_F(PointFollowing, FindsTheSameWithAHelper) {
  concurrency::ParallelFor helper;
  const auto with_helper = [&](std::size_t count, const auto& part) { helper.run(count, part); };
  const MovableMask movable = test::mask_of({50, 60, 80, 140});
  for (const int points : {0, 30, 130, 400}) {
    wanted = points;
    const FollowedPoints alone = follow(movable);
    expect_same(alone, follow(movable, with_helper));
    PointSearch ahead = search();
    std::atomic<bool> enough = false;
    std::jthread other([&] { ahead.prefetch(enough); });
    enough = points == 30;
    other.join();
    expect_same(alone, ahead.find(movable, with_helper));
  }
}

TEST_F(PointFollowing, StopsAtTheBudgetAndSpreadsIt) {
  wanted = 60;
  const FollowedPoints followed = follow();
  ASSERT_EQ(followed.points.size(), 60U);
  std::set<std::pair<int, int>> parts;
  for (const Feature& f : followed.features)
    parts.insert({static_cast<int>(f.image_px.x()) / 80, static_cast<int>(f.image_px.y()) / 80});
  EXPECT_GE(parts.size(), 10U);
}

TEST_F(PointFollowing, DoesNotLookWhereSomethingMovableHides) {
  const MovableMask left = test::mask_of({0, 0, 160, 240});
  const FollowedPoints followed = follow(left);
  std::size_t hidden = 0;
  for (std::size_t i = 0; i < followed.points.size(); ++i) {
    EXPECT_EQ(followed.features[i].movable, followed.points[i] == kNoId);
    if (followed.points[i] != kNoId) {
      EXPECT_GT(followed.features[i].image_px.x(), 157);
    }
    hidden += followed.features[i].movable ? 1 : 0;
  }
  EXPECT_GT(hidden, 30U);
}

TEST_F(PointFollowing, FindsNothingOfWhatIsCovered) {
  picture.color.pixels(cv::Rect(0, 0, 160, 240)).setTo(cv::Scalar(90, 90, 90));
  images = pyramid_of(picture);
  for (const Feature& f : follow().features) EXPECT_GT(f.image_px.x(), 150);
}

TEST_F(PointFollowing, NeedsTheKeyframesPicture) {
  map.keyframe(0)->images = nullptr;
  EXPECT_TRUE(follow().points.empty());
}

}  // namespace
}  // namespace rds::tracker
