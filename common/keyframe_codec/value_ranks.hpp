// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace rds::keyframe_codec {

constexpr std::size_t kMostValues = 65536;

/// Replaces each pixel by the rank of its value among those that occur. A camera that measures disparity
/// knows few depths (some hundreds), and the further away they are, the larger the steps between them:
/// differences of ranks are smaller than those of depths.
///
/// @param ranks  becomes as large as `pixels`.
/// @return the values that occur, ascending.
std::vector<std::uint16_t> rank_values(const cv::Mat1w& pixels, cv::Mat1w& ranks);

/// Replaces the ranks by the values. @return false, with pixels half done, if there is no value of a rank.
bool values_of_ranks(const std::vector<std::uint16_t>& values, cv::Mat1w& pixels);

}  // namespace rds::keyframe_codec
