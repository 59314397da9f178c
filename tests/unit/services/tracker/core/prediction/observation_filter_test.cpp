// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/observation_filter.hpp"

#include <limits>

#include <gmock/gmock.h>

namespace rds::tracker::prediction {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr ObservationLimits kLimits{0.2, 0.7, 10};

geometry::OrientedBox box_at(const Eigen::Vector3d& center, const Eigen::Vector3d& size) {
  geometry::OrientedBox box;
  box.map_from_box.translation() = center;
  box.size = size;
  return box;
}

ObjectObservation person(const Eigen::Vector3d& center, float score = 0.9F) {
  return {box_at(center, {0.5, 1.7, 0.6}), "person", score};
}

TEST(ObservationFilter, KeepsTheBetterOfTwoBoxesOfOneObject) {
  const auto kept = usable(std::vector{person({0, 0, 2}, 0.5F), person({0.05, 0.1, 2.1}, 0.8F)}, kLimits);
  ASSERT_THAT(kept, SizeIs(1));
  EXPECT_EQ(kept[0].score, 0.8F);
}

TEST(ObservationFilter, TakesAPartOfAnObjectForADuplicate) {
  const ObjectObservation half{box_at({0, -0.3, 2}, {0.4, 0.8, 0.6}), "person", 0.6F};
  EXPECT_THAT(usable(std::vector{person({0, 0, 2}), half}, kLimits), SizeIs(1));
}

TEST(ObservationFilter, KeepsNeighboursObjectsBehindEachOtherAndOtherLabels) {
  const ObjectObservation chair{box_at({0, 0, 2}, {0.5, 1.7, 0.6}), "chair", 0.9F};
  EXPECT_THAT(usable(std::vector{person({0, 0, 2}), person({0.4, 0, 2}), person({0, 0, 3}), chair}, kLimits),
              SizeIs(4));
}

TEST(ObservationFilter, IgnoresWhatCannotBeABox) {
  const std::vector<ObjectObservation> bad = {person({kNan, 0, 2}),
                                              person({0, 0, 1e6}),
                                              person({0, 0, 2}, static_cast<float>(kNan)),
                                              person({0, 0, 2}, 0.1F),
                                              {box_at({0, 0, 2}, {0, 1, 1}), "person", 0.9F},
                                              {box_at({0, 0, 2}, {1, -1, 1}), "person", 0.9F},
                                              {box_at({0, 0, 2}, {1e5, 1, 1}), "person", 0.9F},
                                              {box_at({0, 0, 2}, {kNan, 1, 1}), "person", 0.9F}};
  EXPECT_THAT(usable(bad, kLimits), IsEmpty());
}

TEST(ObservationFilter, TakesTheBestWhenThereAreTooMany) {
  std::vector<ObjectObservation> many;
  for (int i = 0; i < 50; ++i) many.push_back(person({2. * i, 0, 2}, 0.3F + 0.01F * static_cast<float>(i)));
  const auto kept = usable(many, kLimits);
  ASSERT_THAT(kept, SizeIs(10));
  EXPECT_EQ(kept[0].score, many.back().score);
}

}  // namespace
}  // namespace rds::tracker::prediction
