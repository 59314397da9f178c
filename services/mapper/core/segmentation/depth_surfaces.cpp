// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/depth_surfaces.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "services/mapper/core/segmentation/depth_edges.hpp"

namespace rds::mapper {
namespace {

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
  return c == PixelClass::kStatic || c == PixelClass::kUnknown;
}

PixelSets join_neighbours(const KeyframeRecord& record) {
  PixelSets sets(record.size());
  constexpr auto kStepAt1m = static_cast<int>(kSurfaceStepM * kOneMetre);
  const auto width = static_cast<std::size_t>(record.width);
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
