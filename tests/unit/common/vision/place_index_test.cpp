// SPDX-License-Identifier: Apache-2.0
#include "common/vision/place_index.hpp"

#include <stdexcept>

#include <gmock/gmock.h>

namespace rds::vision {
namespace {

cv::Mat random_descriptors(int rows, std::uint64_t seed) {
  cv::Mat descriptors(rows, 32, CV_8U);
  cv::RNG(seed).fill(descriptors, cv::RNG::UNIFORM, 0, 256);
  return descriptors;
}

/// Each bit flipped with probability `share`, as between two views of a place.
cv::Mat with_flipped_bits(const cv::Mat& descriptors, double share, std::uint64_t seed) {
  cv::Mat noisy = descriptors.clone();
  cv::RNG rng(seed);
  for (int row = 0; row < noisy.rows; ++row)
    for (int bit = 0; bit < 256; ++bit)
      if (rng.uniform(0.0, 1.0) < share)
        noisy.at<std::uint8_t>(row, bit / 8) ^= static_cast<std::uint8_t>(1 << (bit % 8));
  return noisy;
}

TEST(PlaceIndex, FindsTheKeyframeItselfWithScoreOne) {
  PlaceIndex index;
  for (std::uint64_t id = 0; id < 20; ++id) index.add(id, random_descriptors(300, id + 1));
  const auto candidates = index.query(random_descriptors(300, 8), 3);
  ASSERT_FALSE(candidates.empty());
  EXPECT_EQ(candidates[0].id, 7U);
  EXPECT_NEAR(candidates[0].score, 1.0, 1e-9);
  EXPECT_EQ(candidates[0].matches, 300);
}

TEST(PlaceIndex, FindsAPlaceWhoseDescriptorsChangedByFifteenPercentOfTheirBits) {
  PlaceIndex index;
  for (std::uint64_t id = 0; id < 50; ++id) index.add(id, random_descriptors(300, id + 1));
  const auto candidates = index.query(with_flipped_bits(random_descriptors(300, 31), 0.15, 99), 2);
  ASSERT_FALSE(candidates.empty());
  EXPECT_EQ(candidates[0].id, 30U);
  EXPECT_GT(candidates[0].score, 0.05);
  for (std::size_t i = 1; i < candidates.size(); ++i) EXPECT_LT(candidates[i].score, 0.005);
}

TEST(PlaceIndex, GivesAnUnknownPlaceScoresNearZero) {
  PlaceIndex index;
  for (std::uint64_t id = 0; id < 50; ++id) index.add(id, random_descriptors(300, id + 1));
  for (const auto& candidate : index.query(random_descriptors(300, 1000), 10))
    EXPECT_LT(candidate.score, 0.005);
}

TEST(PlaceIndex, FeaturesSeenEverywhereWeighLittle) {
  const cv::Mat everywhere = random_descriptors(200, 500);
  PlaceIndex index;
  for (std::uint64_t id = 0; id < 30; ++id) {
    cv::Mat both;
    cv::vconcat(everywhere, random_descriptors(50, id + 1), both);
    index.add(id, both);
  }
  cv::Mat query;
  cv::vconcat(everywhere, random_descriptors(50, 13), query);
  const auto candidates = index.query(query, 2);
  ASSERT_EQ(candidates.size(), 2U);
  EXPECT_EQ(candidates[0].id, 12U);
  EXPECT_GT(candidates[0].score, 5 * candidates[1].score);
}

TEST(PlaceIndex, ForgetsARemovedKeyframeAndReusesItsPlace) {
  PlaceIndex index;
  index.add(1, random_descriptors(100, 1));
  index.add(2, random_descriptors(100, 2));
  index.remove(1);
  index.remove(77);
  EXPECT_EQ(index.size(), 1U);
  EXPECT_TRUE(index.query(random_descriptors(100, 1), 5).empty());
  index.add(3, random_descriptors(100, 1));
  EXPECT_EQ(index.query(random_descriptors(100, 1), 5).at(0).id, 3U);
}

TEST(PlaceIndex, ReplacesAKeyframeThatIsAddedAgain) {
  PlaceIndex index;
  index.add(1, random_descriptors(100, 1));
  index.add(1, random_descriptors(100, 2));
  EXPECT_EQ(index.size(), 1U);
  EXPECT_TRUE(index.query(random_descriptors(100, 1), 5).empty());
  EXPECT_NEAR(index.query(random_descriptors(100, 2), 5).at(0).score, 1.0, 1e-9);
}

TEST(PlaceIndex, AnswerDoesNotDependOnTheOrderOfInsertionAndRemoval) {
  PlaceIndex forward;
  PlaceIndex backward;
  const cv::Mat query = with_flipped_bits(random_descriptors(200, 5), 0.1, 4);
  for (std::uint64_t id = 0; id < 20; ++id) forward.add(id, random_descriptors(200, id % 6));
  backward.add(100, query);
  for (std::uint64_t id = 20; id-- > 0;) backward.add(id, random_descriptors(200, id % 6));
  backward.remove(100);
  EXPECT_EQ(forward.query(query, 20), backward.query(query, 20));
}

TEST(PlaceIndex, TakesEmptyDescriptorsAndRefusesOtherForms) {
  PlaceIndex index;
  EXPECT_TRUE(index.query(cv::Mat(), 5).empty());
  index.add(1, cv::Mat());
  index.add(2, cv::Mat(0, 32, CV_8U));
  EXPECT_TRUE(index.query(random_descriptors(10, 1), 5).empty());
  EXPECT_TRUE(index.contains(1));
  EXPECT_THROW(index.add(3, cv::Mat::zeros(4, 31, CV_8U)), std::invalid_argument);
  EXPECT_THROW(index.add(3, cv::Mat::zeros(4, 32, CV_32F)), std::invalid_argument);
  EXPECT_THROW((void)index.query(cv::Mat::zeros(4, 16, CV_8U), 5), std::invalid_argument);
  EXPECT_FALSE(index.contains(3));
}

}  // namespace
}  // namespace rds::vision
