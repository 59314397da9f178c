// SPDX-License-Identifier: Apache-2.0
#include "common/keyframe_codec/value_ranks.hpp"

#include <algorithm>

namespace rds::keyframe_codec {

std::vector<std::uint16_t> rank_values(const cv::Mat1w& pixels, cv::Mat1w& ranks) {
  std::vector<std::uint16_t> rank_of(kMostValues);  // first whether a value occurs
  for (int y = 0; y < pixels.rows; ++y)
    for (int x = 0; x < pixels.cols; ++x) rank_of[pixels(y, x)] = 1;
  std::vector<std::uint16_t> values;
  for (std::size_t value = 0; value < kMostValues; ++value) {
    if (rank_of[value] == 0) continue;
    rank_of[value] = static_cast<std::uint16_t>(values.size());
    values.push_back(static_cast<std::uint16_t>(value));
  }
  ranks.create(pixels.size());
  for (int y = 0; y < pixels.rows; ++y)
    std::transform(pixels[y], pixels[y] + pixels.cols, ranks[y],
                   [&](std::uint16_t value) { return rank_of[value]; });
  return values;
}

bool values_of_ranks(const std::vector<std::uint16_t>& values, cv::Mat1w& pixels) {
  for (int y = 0; y < pixels.rows; ++y)
    for (int x = 0; x < pixels.cols; ++x) {
      std::uint16_t& pixel = pixels(y, x);
      if (pixel >= values.size()) return false;
      pixel = values[pixel];
    }
  return true;
}

}  // namespace rds::keyframe_codec
