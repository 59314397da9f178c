// SPDX-License-Identifier: Apache-2.0
#include "common/keyframe_codec/value_ranks.hpp"

#include <gmock/gmock.h>

namespace rds::keyframe_codec {
namespace {

TEST(ValueRanks, AreThePlacesOfValuesAmongThoseThatOccur) {
  const cv::Mat1w depth = (cv::Mat1w(2, 3) << 0, 65535, 700, 700, 0, 1200);
  cv::Mat1w ranks;
  EXPECT_THAT(rank_values(depth, ranks), testing::ElementsAre(0, 700, 1200, 65535));
  const cv::Mat1w expected = (cv::Mat1w(2, 3) << 0, 3, 1, 1, 0, 2);
  EXPECT_EQ(cv::norm(ranks, expected, cv::NORM_L1), 0);
}

TEST(ValueRanks, GiveEveryValueBack) {
  cv::Mat1w all(256, 256);
  for (int i = 0; i < 65536; ++i)
    all(i / 256, i % 256) = static_cast<std::uint16_t>(40503U * static_cast<unsigned>(i));
  cv::Mat1w pixels;
  const auto values = rank_values(all, pixels);
  EXPECT_EQ(values.size(), kMostValues);
  EXPECT_TRUE(values_of_ranks(values, pixels));
  EXPECT_EQ(cv::norm(pixels, all, cv::NORM_L1), 0);
}

TEST(ValueRanks, SayWhereThereIsNoValue) {
  cv::Mat1w ranks = (cv::Mat1w(1, 3) << 0, 2, 1);
  EXPECT_FALSE(values_of_ranks({10, 20}, ranks));
}

}  // namespace
}  // namespace rds::keyframe_codec
