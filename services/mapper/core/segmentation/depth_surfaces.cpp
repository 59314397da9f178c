// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/depth_surfaces.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numeric>

#include <opencv2/imgproc.hpp>

namespace rds::mapper {
namespace {

constexpr int kNoReturnRadius = 4;  // sampled pixels
constexpr std::uint32_t kMinPixels = 8;
constexpr int kOneMetre = 10000;  // in depth_tenth_mm

/// Disjoint sets of pixels; the lowest one stands for its set.
class PixelSets {
 public:
  explicit PixelSets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0U); }

  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

bool may_be_static(PixelClass c) {
  return looks_static(c) || c == PixelClass::kUnknown;
}

PixelSets join_neighbours(const KeyframeRecord& record) {
  PixelSets sets(record.size());
  constexpr auto kStepAt1m = static_cast<int>(kSurfaceStepM * kOneMetre);
  const auto width = static_cast<std::size_t>(record.grid.width);
  const auto try_join = [&](std::size_t a, std::size_t b) {
    if (!may_be_static(record.classes[b])) return;
    const int depth = record.depth_tenth_mm[a];
    const int step = depth <= kOneMetre ? kStepAt1m : depth / 100 * kStepAt1m / 100;
    if (std::abs(record.depth_tenth_mm[b] - depth) <= step)
      sets.join(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
  };
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (!may_be_static(record.classes[i])) continue;
    if (i % width != 0) try_join(i, i - 1);
    if (i >= width) try_join(i, i - width);
  }
  return sets;
}

}  // namespace

cv::Mat1b without_depth_all_around(const KeyframeRecord& record) {
  cv::Mat1b none(record.grid.height, record.grid.width);
  for (int row = 0; row < record.grid.height; ++row)
    for (int column = 0; column < record.grid.width; ++column)
      none(row, column) = record.depth_tenth_mm[record.grid.index(column, row)] == 0 ? 255 : 0;
  const int side = 2 * kNoReturnRadius + 1;
  cv::erode(none, none, cv::getStructuringElement(cv::MORPH_RECT, {side, side}), {-1, -1}, 1,
            cv::BORDER_CONSTANT, cv::Scalar(0));
  return none;
}

bool is_on_surface(const KeyframeRecord& record, int column, int row, const SamplingConfig& config) {
  constexpr float kToleranceAt1m = static_cast<float>(kSurfaceStepM) * kTenthMmPerM;
  const std::uint16_t* middle = &record.depth_tenth_mm[record.grid.index(column, row)];
  const int depth = *middle;
  const float scale = std::max(1.0F, static_cast<float>(depth) / kTenthMmPerM);
  const auto tolerance = static_cast<int>(kToleranceAt1m * scale);
  const int left = column > 0 ? -1 : 0;
  const int right = column + 1 < record.grid.width ? 1 : 0;
  int count = -1;  // itself
  for (int r = row > 0 ? -1 : 0; r <= (row + 1 < record.grid.height ? 1 : 0) && count < config.edge_support;
       ++r)
    for (int c = left; c <= right; ++c)
      count += std::abs(middle[r * record.grid.width + c] - depth) <= tolerance ? 1 : 0;
  return count >= config.edge_support;
}

std::uint16_t find_surfaces(const KeyframeRecord& record, std::vector<std::uint16_t>& surface) {
  PixelSets sets = join_neighbours(record);
  std::vector<std::uint32_t> pixels(record.size(), 0);
  for (std::uint32_t i = 0; i < record.size(); ++i) ++pixels[sets.root(i)];
  surface.assign(record.size(), 0);
  std::uint16_t surfaces = 0;
  for (std::uint32_t i = 0; i < record.size(); ++i) {
    const std::uint32_t root = sets.root(i);
    if (pixels[root] < kMinPixels || !may_be_static(record.classes[i])) continue;
    if (root == i && surfaces < std::numeric_limits<std::uint16_t>::max()) surface[i] = ++surfaces;
    surface[i] = surface[root];
  }
  return surfaces;
}

}  // namespace rds::mapper
