// SPDX-License-Identifier: Apache-2.0
#include "common/vision/descriptor_matching.hpp"

#include <stdexcept>

#include <gmock/gmock.h>

namespace rds::vision {
namespace {

cv::Mat random_descriptors(int rows, std::uint64_t seed) {
  cv::Mat descriptors(rows, 32, CV_8U);
  cv::RNG(seed).fill(descriptors, cv::RNG::UNIFORM, 0, 256);
  return descriptors;
}

TEST(DescriptorMatching, CountsDifferingBits) {
  cv::Mat pair = cv::Mat::zeros(2, 32, CV_8U);
  EXPECT_EQ(hamming_distance(pair.ptr(0), pair.ptr(1)), 0);
  pair.at<std::uint8_t>(1, 0) = 0xFF;
  pair.at<std::uint8_t>(1, 31) = 0x81;
  EXPECT_EQ(hamming_distance(pair.ptr(0), pair.ptr(1)), 10);
}

TEST(DescriptorMatching, RecoversAPermutation) {
  const cv::Mat query = random_descriptors(60, 1);
  cv::Mat train;
  for (int i = 0; i < query.rows; ++i) train.push_back(query.row((7 * i) % query.rows));
  const auto matches = match_descriptors(query, train, {});
  ASSERT_EQ(matches.size(), 60U);
  for (const auto& match : matches) {
    EXPECT_EQ(match.query, (7 * match.train) % query.rows);
    EXPECT_EQ(match.distance, 0);
  }
}

TEST(DescriptorMatching, DropsAmbiguousAndDistantPairs) {
  const cv::Mat query = random_descriptors(2, 1);
  cv::Mat train = random_descriptors(1, 9);  // far from both
  train.push_back(query.row(0));
  train.push_back(query.row(0));  // a twin makes row 0 ambiguous
  train.push_back(query.row(1));
  const auto matches = match_descriptors(query, train, {});
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0], (DescriptorMatch{1, 3, 0}));
}

TEST(DescriptorMatching, TakesEmptyInputAndRefusesOtherForms) {
  EXPECT_TRUE(match_descriptors(cv::Mat(), random_descriptors(3, 1), {}).empty());
  EXPECT_TRUE(match_descriptors(random_descriptors(3, 1), cv::Mat(), {}).empty());
  EXPECT_THROW((void)match_descriptors(cv::Mat::zeros(1, 8, CV_8U), cv::Mat(), {}), std::invalid_argument);
}

}  // namespace
}  // namespace rds::vision
