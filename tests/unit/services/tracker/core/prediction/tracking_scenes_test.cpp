// SPDX-License-Identifier: Apache-2.0
// Properties of both algorithms in synthetic scenes: a moving camera, people who cross, faulty detectors.
#include <random>
#include <set>

#include <gmock/gmock.h>

#include "services/tracker/core/prediction/image_projection.hpp"
#include "services/tracker/core/prediction/kalman_tracking.hpp"
#include "services/tracker/core/prediction/object_predictor.hpp"
#include "tests/unit/services/tracker/core/prediction/scene.hpp"

namespace rds::tracker::prediction {
namespace {

using geometry::Pose;
using scene::nanoseconds;
using ::testing::SizeIs;

ObjectPredictor predictor(const std::string& algorithm) {
  PredictionConfig config;
  config.algorithm = algorithm;
  return ObjectPredictor(config);
}

/// A hand-held camera that looks along z and sways in all six directions.
Pose swaying_camera(double t) {
  const Eigen::Quaterniond rotation = Eigen::AngleAxisd(0.15 * std::sin(2.1 * t), Eigen::Vector3d::UnitX()) *
                                      Eigen::AngleAxisd(0.25 * std::sin(1.3 * t), Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(0.3 * std::sin(2.9 * t), Eigen::Vector3d::UnitZ());
  return geometry::make_pose({0.4 * std::sin(t), 0.2 * std::sin(1.7 * t), 0.5 * std::sin(0.8 * t)}, rotation);
}

std::vector<ObjectObservation> see(const std::vector<Eigen::Vector3d>& places, const Pose& map_from_camera) {
  std::vector<ObjectObservation> seen;
  for (const Eigen::Vector3d& place : places)
    if (const auto person = scene::see_person(place, map_from_camera)) seen.push_back(*person);
  return seen;
}

class TrackingScenes : public ::testing::TestWithParam<const char*> {};

TEST_P(TrackingScenes, AStaticObjectStaysStaticUnderAnyCameraMotion) {
  ObjectPredictor p = predictor(GetParam());
  const Eigen::Vector3d place(0.1, -0.05, 3);
  for (double t = 0.2; t < 10; t += 0.2) {
    p.update(nanoseconds(t), see({place}, swaying_camera(t)));
    const auto objects = p.predict(nanoseconds(t + 0.2));
    ASSERT_THAT(objects, SizeIs(1)) << t;
    EXPECT_EQ(objects[0].id, 1U);
    EXPECT_LT((objects[0].box.center() - place).norm(), 0.01) << t;
    EXPECT_LT(objects[0].velocity.norm(), 0.02) << t;
  }
}

TEST_P(TrackingScenes, PeopleWhoCrossKeepTheirIds) {
  ObjectPredictor p = predictor(GetParam());
  const auto left = [](double t) { return Eigen::Vector3d(-1.5 + 0.7 * t, 0, 2.4); };
  const auto right = [](double t) { return Eigen::Vector3d(1.5 - 0.7 * t, 0, 3.6); };
  for (double t = 0; t < 4; t += 0.2)
    p.update(nanoseconds(t + 1), see({left(t), right(t)}, Pose::Identity()));
  const auto objects = p.predict(nanoseconds(5));
  ASSERT_THAT(objects, SizeIs(2));
  EXPECT_LT((objects[0].box.center() - left(4)).norm(), 0.3);
  EXPECT_LT((objects[1].box.center() - right(4)).norm(), 0.3);
}

INSTANTIATE_TEST_SUITE_P(Both, TrackingScenes, ::testing::Values("paper", "kalman3d"),
                         [](const auto& algorithm) { return std::string(algorithm.param); });

TEST(Kalman3dScenes, IdsSurviveDroppedFalseNoisyAndDuplicateDetections) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  ObjectPredictor p = predictor("kalman3d");
  double t = 0;
  while (t < 4) {
    t += 0.1 + 0.2 * uniform(random);  // uneven key frames
    std::vector<Eigen::Vector3d> places;
    for (const Eigen::Vector3d& truth :
         {Eigen::Vector3d(-1.5 + 0.7 * t, 0, 2.4), Eigen::Vector3d(1.5 - 0.7 * t, 0, 3.6)}) {
      if (t > 0.7 && uniform(random) < 0.15) continue;  // dropped
      places.emplace_back(
          truth + Eigen::Vector3d(0.03 * normal(random), 0.03 * normal(random), 0.06 * normal(random)));
      if (uniform(random) < 0.2) places.push_back(places.back() + Eigen::Vector3d(0.03, 0.02, 0.05));
    }
    if (uniform(random) < 0.2) places.emplace_back(-1.4 + 3 * uniform(random), 0.3, 6);  // false
    p.update(nanoseconds(t + 1), see(places, Pose::Identity()));
  }
  const auto objects = p.predict(nanoseconds(t + 1));
  ASSERT_GE(objects.size(), 2U);
  EXPECT_EQ(objects[0].id, 1U);
  EXPECT_EQ(objects[1].id, 2U);
  EXPECT_LT((objects[0].box.center() - Eigen::Vector3d(-1.5 + 0.7 * t, 0, 2.4)).norm(), 0.4);
  EXPECT_LT((objects[1].box.center() - Eigen::Vector3d(1.5 - 0.7 * t, 0, 3.6)).norm(), 0.4);
}

TEST(Kalman3dScenes, SomebodyWhoStopsIsNotCarriedOn) {
  ObjectPredictor p = predictor("kalman3d");
  const auto walker = [](double t) { return Eigen::Vector3d(-1 + 0.8 * std::min(t, 1.5), 0, 3); };
  for (double t = 0; t < 2.5; t += 0.2) p.update(nanoseconds(t + 1), see({walker(t)}, Pose::Identity()));
  const auto objects = p.predict(nanoseconds(3.6));
  ASSERT_THAT(objects, SizeIs(1));
  EXPECT_LT(objects[0].velocity.norm(), 0.1);
  EXPECT_LT((objects[0].box.center() - walker(2.5)).norm(), 0.06);
}

TEST(Kalman3dScenes, SomebodyBehindAnotherIsRememberedLongerThanAGhost) {
  const KeyframeView view{Pose::Identity(), scene::camera()};
  ObjectPredictor hidden = predictor("kalman3d");
  ObjectPredictor ghost = predictor("kalman3d");
  for (ObjectPredictor* p : {&hidden, &ghost})
    for (double t : {1.0, 1.2}) p->update(nanoseconds(t), see({{0, 0, 4}}, Pose::Identity()), view);
  for (double t : {1.4, 1.6, 1.8, 2.0}) {
    hidden.update(nanoseconds(t), see({{0.05, 0, 2}}, Pose::Identity()), view);
    ghost.update(nanoseconds(t), see({{1, 0, 2}}, Pose::Identity()), view);
  }
  EXPECT_THAT(hidden.predict(nanoseconds(2)), SizeIs(2));
  EXPECT_THAT(ghost.predict(nanoseconds(2)), SizeIs(1));
}

TEST(Kalman3dScenes, ALoopClosureThatMovesTheMapCarriesTheObjectsAlong) {
  const Pose new_from_old = geometry::make_pose(
      {0.5, -0.2, 0.3}, Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized())));
  ObjectPredictor moved = predictor("kalman3d");
  ObjectPredictor still = predictor("kalman3d");
  for (double t = 0; t < 1; t += 0.2)
    for (ObjectPredictor* p : {&moved, &still})
      p->update(nanoseconds(t + 1), see({{-0.5 + 0.6 * t, 0, 3}}, Pose::Identity()));
  moved.move_map(new_from_old);
  const auto a = moved.predict(nanoseconds(2));
  const auto b = still.predict(nanoseconds(2));
  ASSERT_THAT(a, SizeIs(1));
  ASSERT_THAT(b, SizeIs(1));
  EXPECT_LT((a[0].box.center() - new_from_old * b[0].box.center()).norm(), 1e-9);
  EXPECT_LT((a[0].velocity - new_from_old.linear() * b[0].velocity).norm(), 1e-9);
  const auto in_new = image_box(a[0].box, new_from_old.inverse(), scene::camera());
  const auto in_old = image_box(b[0].box, Pose::Identity(), scene::camera());
  EXPECT_GT(geometry::iou(in_new.value(), in_old.value()), 0.9999);
}

TEST(Kalman3dScenes, TheBoxOfAMissedObjectGrowsUpToItsLimit) {
  ObjectPredictor p = predictor("kalman3d");
  for (double t = 0.2; t < 1; t += 0.2) p.update(nanoseconds(t), see({{0, 0, 3}}, Pose::Identity()));
  double width = 0;
  for (double ahead : {0.0, 0.2, 0.4, 0.6}) {
    const auto objects = p.predict(nanoseconds(0.8 + ahead));
    ASSERT_THAT(objects, SizeIs(1));
    EXPECT_GT(objects[0].box.size.x(), width);
    width = objects[0].box.size.x();
    EXPECT_LE(width, 0.5 + 2 * KalmanTracking::kMaxGrowthM + 1e-6);
  }
}

}  // namespace
}  // namespace rds::tracker::prediction
