// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace rds::vision {

/// Row `query` of one descriptor matrix resembles row `train` of the other.
struct DescriptorMatch {
  int query = 0;
  int train = 0;
  int distance = 0;  // differing bits

  bool operator==(const DescriptorMatch&) const = default;
};

struct DescriptorMatchConfig {
  int max_distance = 60;   // bits of 256
  double max_ratio = 0.8;  // best to second best distance, Lowe 2004

  bool operator==(const DescriptorMatchConfig&) const = default;
};

/// Number of differing bits of two 32-byte descriptors.
[[nodiscard]] int hamming_distance(const std::uint8_t* a, const std::uint8_t* b);

/// Brute-force matches that are each other's nearest and clearly better than the second nearest, by ascending
/// query row.
///
/// @param query, train  N×32 and M×32 CV_8U, may be empty. @throws std::invalid_argument for another form.
[[nodiscard]] std::vector<DescriptorMatch> match_descriptors(const cv::Mat& query, const cv::Mat& train,
                                                             const DescriptorMatchConfig& config);

}  // namespace rds::vision
