// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/object_predictor.hpp"

#include <limits>

#include <gmock/gmock.h>

#include "tests/unit/services/tracker/core/prediction/scene.hpp"

namespace rds::tracker::prediction {
namespace {

using geometry::Pose;
using scene::nanoseconds;
using ::testing::IsEmpty;
using ::testing::SizeIs;

ObjectObservation person_at(double x, const std::string& label = "person") {
  return *scene::see_person({x, 0, 3}, Pose::Identity(), label);
}

class ObjectPredictorOf : public ::testing::TestWithParam<const char*> {
 protected:
  static ObjectPredictor predictor() {
    PredictionConfig config;
    config.algorithm = GetParam();
    return ObjectPredictor(config);
  }
};

TEST_P(ObjectPredictorOf, KnowsNothingBeforeTheFirstDetections) {
  EXPECT_THAT(predictor().predict(nanoseconds(1)), IsEmpty());
}

TEST_P(ObjectPredictorOf, ShowsAnObjectAfterOneDetection) {
  ObjectPredictor p = predictor();
  EXPECT_TRUE(p.update(nanoseconds(1), std::vector{person_at(0.2)}));
  const auto objects = p.predict(nanoseconds(1.1));
  ASSERT_THAT(objects, SizeIs(1));
  EXPECT_TRUE(objects[0].box.center().isApprox(Eigen::Vector3d(0.2, 0, 3), 1e-3));
  EXPECT_EQ(objects[0].label, "person");
  EXPECT_EQ(objects[0].score, 0.9F);
  EXPECT_TRUE(objects[0].movable);
  EXPECT_NEAR(objects[0].age_s, 0.1, 1e-9);
  EXPECT_GT(objects[0].covariance_trace, 0);
}

TEST_P(ObjectPredictorOf, FollowsAWalkerBetweenUnevenKeyFrames) {
  ObjectPredictor p = predictor();
  double t = 0;
  for (const double step : {0.2, 0.1, 0.3, 0.2, 0.15, 0.25, 0.2, 0.3, 0.1}) {
    t += step;
    p.update(nanoseconds(t), std::vector{person_at(-1 + 0.8 * t)});
  }
  const auto objects = p.predict(nanoseconds(t + 0.2));
  ASSERT_THAT(objects, SizeIs(1));
  EXPECT_EQ(objects[0].id, 1U);
  EXPECT_NEAR(objects[0].velocity.x(), 0.8, 0.1);
  EXPECT_NEAR(objects[0].velocity.z(), 0, 0.1);
  EXPECT_NEAR(objects[0].box.center().x(), -1 + 0.8 * (t + 0.2), 0.05);
}

TEST_P(ObjectPredictorOf, DoesNotAgeThroughAsking) {
  ObjectPredictor asked = predictor();
  ObjectPredictor quiet = predictor();
  for (double t : {0.2, 0.4, 0.6}) {
    for (ObjectPredictor* p : {&asked, &quiet}) p->update(nanoseconds(t), std::vector{person_at(t)});
    for (double ahead : {0.3, 0.1, 5., 0.2}) (void)asked.predict(nanoseconds(t + ahead));
  }
  const auto a = asked.predict(nanoseconds(0.7));
  const auto b = quiet.predict(nanoseconds(0.7));
  ASSERT_THAT(a, SizeIs(1));
  ASSERT_THAT(b, SizeIs(1));
  EXPECT_EQ(a[0].box.center(), b[0].box.center());
  EXPECT_EQ(a[0].covariance_trace, b[0].covariance_trace);
}

TEST_P(ObjectPredictorOf, GrowsUncertainAboutAMissedObjectThenForgetsIt) {
  ObjectPredictor p = predictor();
  for (double t : {0.2, 0.4, 0.6}) p.update(nanoseconds(t), std::vector{person_at(0)});
  const double seen = p.predict(nanoseconds(0.6))[0].covariance_trace;
  p.update(nanoseconds(0.8), {});
  const auto missed = p.predict(nanoseconds(0.9));
  ASSERT_THAT(missed, SizeIs(1));
  EXPECT_GT(missed[0].covariance_trace, seen);
  EXPECT_NEAR(missed[0].age_s, 0.3, 1e-9);
  EXPECT_THAT(p.predict(nanoseconds(20)), IsEmpty());
  p.update(nanoseconds(20), {});
  p.update(nanoseconds(20.2), std::vector{person_at(0)});
  const auto again = p.predict(nanoseconds(20.2));
  ASSERT_THAT(again, SizeIs(1));
  EXPECT_EQ(again[0].id, 2U) << "a new object";
}

TEST_P(ObjectPredictorOf, RefusesDetectionsThatAreNotNewer) {
  ObjectPredictor p = predictor();
  EXPECT_TRUE(p.update(nanoseconds(2), std::vector{person_at(0)}));
  EXPECT_FALSE(p.update(nanoseconds(2), {}));
  EXPECT_FALSE(p.update(nanoseconds(1), {}));
  EXPECT_THAT(p.predict(nanoseconds(1)), SizeIs(1)) << "an earlier time gives the state at the update";
}

TEST_P(ObjectPredictorOf, MarksOnlyConfiguredLabelsAsMovable) {
  PredictionConfig config;
  config.algorithm = GetParam();
  config.labels = labels::Table({{"robot", {.movable = true}}});
  ObjectPredictor p(config);
  p.update(nanoseconds(1), std::vector{person_at(-0.5), person_at(0.5, "robot")});
  const auto objects = p.predict(nanoseconds(1));
  ASSERT_THAT(objects, SizeIs(2));
  for (const PredictedObject& object : objects) EXPECT_EQ(object.movable, object.label == "robot");
}

TEST_P(ObjectPredictorOf, SurvivesHostileDetections) {
  ObjectPredictor p = predictor();
  ObjectObservation broken = person_at(0);
  broken.box.size.x() = std::numeric_limits<double>::infinity();
  std::vector<ObjectObservation> flood(3000, person_at(0));
  for (std::size_t i = 0; i < flood.size(); ++i)
    flood[i].box.map_from_box.translation().x() = 3.0 * static_cast<double>(i);
  p.update(nanoseconds(1), std::vector{broken});
  p.update(nanoseconds(1.2), flood);
  p.update(std::numeric_limits<std::int64_t>::max() / 2, std::vector{broken});
  for (const PredictedObject& object : p.predict(std::numeric_limits<std::int64_t>::max() / 2))
    EXPECT_TRUE(geometry::is_valid(object.box));
  p.update(std::numeric_limits<std::int64_t>::max() / 2 + 1, std::vector{person_at(0)});
  EXPECT_LE(p.predict(std::numeric_limits<std::int64_t>::max()).size(), ObjectPredictor::kMaxObservations);
}

TEST_P(ObjectPredictorOf, ForgetsEverythingOnReset) {
  ObjectPredictor p = predictor();
  p.update(nanoseconds(5), std::vector{person_at(0)});
  p.reset();
  EXPECT_THAT(p.predict(nanoseconds(5)), IsEmpty());
  EXPECT_TRUE(p.update(nanoseconds(1), std::vector{person_at(0)})) << "a new run may start earlier";
  EXPECT_THAT(p.predict(nanoseconds(1)), SizeIs(1));
}

INSTANTIATE_TEST_SUITE_P(Both, ObjectPredictorOf, ::testing::Values("paper", "kalman3d"),
                         [](const auto& algorithm) { return std::string(algorithm.param); });

TEST(ObjectPredictor, RejectsAnAlgorithmThatDoesNotExist) {
  PredictionConfig config;
  config.algorithm = "magic";
  EXPECT_THROW(ObjectPredictor{config}, std::invalid_argument);
}

}  // namespace
}  // namespace rds::tracker::prediction
