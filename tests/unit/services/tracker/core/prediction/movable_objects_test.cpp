// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/movable_objects.hpp"

#include <gmock/gmock.h>

#include "tests/unit/services/tracker/core/prediction/scene.hpp"

namespace rds::tracker {
namespace {

using geometry::Pose;
using prediction::scene::nanoseconds;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<prediction::ObjectObservation> person_with(float score) {
  auto person = *prediction::scene::see_person({0, 0, 3}, Pose::Identity());
  person.score = score;
  return {person};
}

TEST(MovableObjects, ABoxBelowTheLowestScoreIsNeitherFollowedNorCutOut) {
  const auto camera = prediction::scene::camera();
  const prediction::PredictionConfig config;
  for (const bool enough : {false, true}) {
    const auto boxes = person_with(static_cast<float>(config.min_score) + (enough ? 0.01F : -0.01F));
    MovableObjects objects(config);
    objects.observe(nanoseconds(1), boxes, std::nullopt);
    EXPECT_THAT(objects.regions(nanoseconds(1), Pose::Identity(), camera), SizeIs(enough ? 1 : 0));
    EXPECT_THAT(objects.regions_of(boxes, Pose::Identity(), camera), SizeIs(enough ? 1 : 0));
  }
}

}  // namespace
}  // namespace rds::tracker
