// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/classify.hpp"

#include "services/mapper/core/segmentation/depth_surfaces.hpp"
#include "services/mapper/core/segmentation/near_points.hpp"

namespace rds::mapper {
namespace {

/// Rules 4 to 6.
PixelClass class_of(std::size_t pixel, const KeyframeRecord& record, ByBoxes by_boxes) {
  const PixelClass by_depth = record.classes[pixel];
  const bool is_measured = by_depth == PixelClass::kStatic;
  if (by_boxes == ByBoxes::kMovable && is_measured) return PixelClass::kDynamic;  // rule 4
  if (by_boxes >= ByBoxes::kBeside || is_in_movable_cell(record, pixel))          // rules 5 and 6
    return is_measured ? PixelClass::kUnknown : PixelClass::kInvalid;
  return by_depth;
}

/// Points [m, camera] of all that boxes or the tracker know as dynamic.
std::vector<Eigen::Vector3f> dynamic_points(const KeyframeRecord& record, const SamplingConfig& config) {
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (!is_dynamic(record, i)) continue;
    const float depth = record.depth_m(i);
    if (depth >= static_cast<float>(config.min_range_m) && depth <= static_cast<float>(config.max_range_m))
      points.push_back(record.point_in_camera(i));
  }
  return points;
}

/// Rule 7.
void doubt_near_dynamic(KeyframeRecord& record, std::span<const ByBoxes> by_boxes,
                        const MapperConfig& config) {
  if (!(config.confirmation.radius_m > 0)) return;
  const auto dynamic = dynamic_points(record, config.sampling);
  if (dynamic.empty()) return;
  const NearPoints near(dynamic, static_cast<float>(config.confirmation.radius_m));
  for (std::size_t i = 0; i < record.size(); ++i)
    if (record.classes[i] == PixelClass::kStatic &&
        (by_boxes.empty() || by_boxes[i] != ByBoxes::kBackground) && near.contains(record.point_in_camera(i)))
      record.classes[i] = PixelClass::kDoubtful;
}

}  // namespace

void classify_by_depth(KeyframeRecord& record, const SamplingConfig& config) {
  const cv::Mat1b no_return = without_depth_all_around(record);
  const auto nearest = to_tenth_mm(static_cast<float>(config.min_range_m));
  const auto farthest = to_tenth_mm(static_cast<float>(config.max_range_m));
  for (int row = 0; row < record.grid.height; ++row)
    for (int column = 0; column < record.grid.width; ++column) {
      const auto i = record.grid.index(column, row);
      const auto depth = record.depth_tenth_mm[i];
      auto& its_class = record.classes[i];
      its_class = no_return(row, column) != 0 ? PixelClass::kNoReturn : PixelClass::kInvalid;  // rule 1
      const bool is_far_enough = depth != 0 && depth >= nearest;
      if (!is_far_enough || !is_on_surface(record, column, row, config.edge_support)) continue;  // rule 2
      its_class = depth <= farthest ? PixelClass::kStatic : PixelClass::kFar;                    // rule 3
    }
}

void classify(KeyframeRecord& record, std::span<const ByBoxes> by_boxes, const MapperConfig& config) {
  if (by_boxes.empty() && record.movable.pixels.empty()) return;  // rules 4 to 7 have nothing to say
  for (std::size_t i = 0; i < record.size(); ++i)
    record.classes[i] = class_of(i, record, by_boxes.empty() ? ByBoxes::kNothing : by_boxes[i]);
  doubt_near_dynamic(record, by_boxes, config);
}

}  // namespace rds::mapper
