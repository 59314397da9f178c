// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/depth_edges.hpp"

#include <algorithm>
#include <cstdlib>

#include <opencv2/imgproc.hpp>

namespace rds::mapper {
namespace {
constexpr int kNoReturnRadius = 4;  // sampled pixels
}

cv::Mat1b without_depth_all_around(const KeyframeRecord& record) {
  cv::Mat1b none(record.height, record.width);
  for (int row = 0; row < record.height; ++row)
    for (int column = 0; column < record.width; ++column)
      none(row, column) =
          record.depth_tenth_mm[static_cast<std::size_t>(row * record.width + column)] == 0 ? 255 : 0;
  const int side = 2 * kNoReturnRadius + 1;
  cv::erode(none, none, cv::getStructuringElement(cv::MORPH_RECT, {side, side}), {-1, -1}, 1,
            cv::BORDER_CONSTANT, cv::Scalar(0));
  return none;
}

bool is_on_surface(const KeyframeRecord& record, int column, int row, const SamplingConfig& config) {
  constexpr float kToleranceAt1m = static_cast<float>(kSurfaceStepM) * kTenthMmPerM;
  const std::uint16_t* middle =
      &record.depth_tenth_mm[static_cast<std::size_t>(row * record.width + column)];
  const int depth = *middle;
  const float scale = std::max(1.0F, static_cast<float>(depth) / kTenthMmPerM);
  const auto tolerance = static_cast<int>(kToleranceAt1m * scale);
  const int left = column > 0 ? -1 : 0;
  const int right = column + 1 < record.width ? 1 : 0;
  int count = -1;  // itself
  for (int r = row > 0 ? -1 : 0; r <= (row + 1 < record.height ? 1 : 0) && count < config.edge_support; ++r)
    for (int c = left; c <= right; ++c)
      count += std::abs(middle[r * record.width + c] - depth) <= tolerance ? 1 : 0;
  return count >= config.edge_support;
}

}  // namespace rds::mapper
