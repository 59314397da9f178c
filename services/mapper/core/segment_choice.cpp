// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "services/mapper/core/segmentation.hpp"

namespace rds::mapper {
namespace {

constexpr double kMinPlaneOverlap = 0.5;

/// IoU, halved when the centres are one mean half diagonal apart. Never divides by a distance.
double fitness(const geometry::Box2& segment, const geometry::Box2& box) {
  const double distance = std::hypot((segment.x0 + segment.x1 - box.x0 - box.x1) / 2,
                                     (segment.y0 + segment.y1 - box.y0 - box.y1) / 2);
  const double half_diagonal =
      (std::hypot(segment.width(), segment.height()) + std::hypot(box.width(), box.height())) / 4;
  return half_diagonal > 0 ? geometry::iou(segment, box) / (1 + distance / half_diagonal) : 0;
}

}  // namespace

const Segment* best_segment(const std::vector<Segment>& segments, const geometry::Box2& box_px,
                            const SegmentationConfig& config) {
  const Segment* best = nullptr;
  double best_fitness = 0;
  for (const auto& segment : segments) {
    const double needed =
        segment.is_plane ? std::max(kMinPlaneOverlap, config.min_overlap) : config.min_overlap;
    if (geometry::iou(segment.box_px, box_px) < needed) continue;
    const double f = fitness(segment.box_px, box_px);
    if (f > best_fitness) {
      best_fitness = f;
      best = &segment;
    }
  }
  return best;
}

}  // namespace rds::mapper
