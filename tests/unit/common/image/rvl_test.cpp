// SPDX-License-Identifier: Apache-2.0
#include "common/image/rvl.hpp"

#include <random>

#include <gtest/gtest.h>

#include "tests/unit/common/image/rvl_encoder.hpp"

namespace rds::image {
namespace {

using test::rvl_of;
using Bytes = std::vector<std::uint8_t>;

bool are_equal(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

/// Depth with holes, edges and noise.
cv::Mat1w noisy_depth(cv::Size size, unsigned seed) {
  std::mt19937 random(seed);
  cv::Mat1w depth(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const int base = x * 3 < size.width ? 900 : 60000;
      depth(y, x) = random() % 5 == 0 ? std::uint16_t{0}
                                      : static_cast<std::uint16_t>(base + static_cast<int>(random() % 400));
    }
  return depth;
}

TEST(Rvl, IsAsThePaperHasIt) {
  // Two zeros, two values; 5 and 2 more, doubled: groups 2, 2, 1010 = 8 + 2 and 1, 4.
  const Bytes bytes{0x00, 0x40, 0xA1, 0x22};
  const cv::Mat1w depth = (cv::Mat1w(1, 4) << 0, 0, 5, 7);
  EXPECT_TRUE(are_equal(decompress_rvl(bytes, {4, 1}), depth));
  EXPECT_EQ(rvl_of(depth), bytes) << "the encoder of the tests";
}

TEST(Rvl, BringsBackWhatAnIndependentEncoderWrote) {
  unsigned seed = 0;
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(7, 5), cv::Size(64, 48), cv::Size(640, 480)}) {
    const cv::Mat1w depth = noisy_depth(size, ++seed);
    EXPECT_TRUE(are_equal(decompress_rvl(rvl_of(depth), size), depth)) << size;
  }
  const cv::Mat1w dark(480, 640, std::uint16_t{0});
  EXPECT_TRUE(are_equal(decompress_rvl(rvl_of(dark), dark.size()), dark)) << "of a covered lens: a few bytes";
  const cv::Mat1w extremes = (cv::Mat1w(1, 3) << 65535, 1, 65535);
  EXPECT_TRUE(are_equal(decompress_rvl(rvl_of(extremes), extremes.size()), extremes));
}

TEST(Rvl, RefusesWhatIsTornOrOfAnotherSize) {
  const cv::Mat1w depth = noisy_depth({64, 48}, 9);
  const Bytes bytes = rvl_of(depth);
  for (std::size_t length = 0; length + 4 <= bytes.size(); length += 3)
    EXPECT_TRUE(decompress_rvl(std::span(bytes).first(length), depth.size()).empty()) << length;
  for (const cv::Size size : {cv::Size(64, 47), cv::Size(63, 48), cv::Size(64, 49), cv::Size(50'000, 50'000),
                              cv::Size(0, 48), cv::Size(-64, -48)})
    EXPECT_TRUE(decompress_rvl(bytes, size).empty()) << size;
}

TEST(Rvl, RefusesNumbersThatMeanNothing) {
  EXPECT_TRUE(decompress_rvl(Bytes(64, 0x00), {4, 4}).empty()) << "empty runs for ever";
  EXPECT_TRUE(decompress_rvl(Bytes(64, 0xFF), {4, 4}).empty()) << "a number without an end";
  EXPECT_TRUE(decompress_rvl(Bytes{0x00, 0x00, 0x00, 0x01}, {1, 1}).empty()) << "a value that is 0";
  EXPECT_TRUE(decompress_rvl(Bytes{0x00, 0x00, 0x10, 0x01}, {1, 1}).empty()) << "a value below 0";
}

}  // namespace
}  // namespace rds::image
