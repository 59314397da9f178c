// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/non_maximum_suppression.hpp"

#include <gmock/gmock.h>

namespace rds::detector {
namespace {

using ::testing::ElementsAre;

std::vector<float> scores_of(const std::vector<Candidate>& candidates) {
  std::vector<float> scores;
  for (const Candidate& c : candidates) scores.push_back(c.score);
  return scores;
}

const geometry::Box2 kBox{0, 0, 100, 100};
const geometry::Box2 kNearlyTheSame{0, 0, 100, 95};
const geometry::Box2 kElsewhere{200, 0, 300, 100};

TEST(NonMaximumSuppression, KeepsTheBestOfOverlappingBoxesOfOneLabel) {
  const auto kept = suppress_non_maxima({{0, .5F, kNearlyTheSame}, {0, .9F, kBox}, {0, .6F, kElsewhere}}, {});
  EXPECT_THAT(scores_of(kept), ElementsAre(.9F, .6F));
}

TEST(NonMaximumSuppression, KeepsBothLabelsOfOneBoxUnlessToldOtherwise) {
  const std::vector<Candidate> dog_and_cat{{0, .7F, kBox}, {1, .9F, kNearlyTheSame}};
  EXPECT_THAT(scores_of(suppress_non_maxima(dog_and_cat, {})), ElementsAre(.9F, .7F));
  SuppressionConfig across_labels;
  across_labels.other_label_iou = 0.85;
  EXPECT_THAT(scores_of(suppress_non_maxima(dog_and_cat, across_labels)), ElementsAre(.9F));
}

TEST(NonMaximumSuppression, ASuppressedBoxSuppressesNothing) {
  const std::vector<Candidate> chain{
      {0, .9F, {0, 0, 100, 100}}, {0, .8F, {0, 30, 100, 130}}, {0, .7F, {0, 60, 100, 160}}};
  EXPECT_THAT(scores_of(suppress_non_maxima(chain, {})), ElementsAre(.9F, .7F));
}

TEST(NonMaximumSuppression, BoxesOfEqualScoreKeepTheirOrder) {
  const auto kept = suppress_non_maxima({{3, .5F, kBox}, {1, .5F, kBox}, {2, .5F, kElsewhere}}, {});
  ASSERT_EQ(kept.size(), 3U);
  EXPECT_EQ(kept[0].label, 3);
  EXPECT_EQ(kept[1].label, 1);
  EXPECT_EQ(kept[2].label, 2);
}

TEST(NonMaximumSuppression, StopsAtTheLargestNumberOfBoxes) {
  std::vector<Candidate> many;
  for (int i = 0; i < 50; ++i)
    many.push_back({0, 0.01F * static_cast<float>(i), {100.0 * i, 0, 100.0 * i + 50, 50}});
  SuppressionConfig config;
  config.max_boxes = 7;
  EXPECT_EQ(suppress_non_maxima(many, config).size(), 7U);
  EXPECT_EQ(suppress_non_maxima(many, config).front().score, many.back().score);
}

}  // namespace
}  // namespace rds::detector
