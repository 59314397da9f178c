// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/classify.hpp"

#include <algorithm>

#include "services/mapper/core/evidence/near_points.hpp"
#include "services/mapper/core/evidence/surface_rules.hpp"
#include "services/mapper/core/segmentation/depth_surfaces.hpp"

namespace rds::mapper {
namespace {

/// Rules 4 to 7.
PixelClass class_of(std::size_t pixel, const KeyframeRecord& record, const DynamicMasks& masks) {
  const PixelClass by_depth = record.classes[pixel];
  const bool is_measured = by_depth == PixelClass::kStatic;
  if (masks.is_background(pixel)) return PixelClass::kStatic;              // rule 4
  if (masks.is_object(pixel) && is_measured) return PixelClass::kDynamic;  // rule 5
  if (masks.is_beside(pixel) || is_in_movable_cell(record, pixel))         // rules 6 and 7
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

/// Rule 8.
bool needs_confirmation(std::size_t pixel, const KeyframeRecord& record, const DynamicMasks& masks,
                        const NearPoints& near_dynamic) {
  if (masks.is_background(pixel)) return false;
  const PixelClass its_class = record.classes[pixel];
  return its_class == PixelClass::kUnknown ||
         (its_class == PixelClass::kStatic && near_dynamic.contains(record.point_in_camera(pixel)));
}

UnconfirmedPixels unconfirmed_pixels(const KeyframeRecord& record, const DynamicMasks& masks,
                                     const MapperConfig& config) {
  if (!(config.confirmation.radius_m > 0)) return {};
  const auto dynamic = dynamic_points(record, config.sampling);
  if (dynamic.empty()) return {};
  const NearPoints near(dynamic, static_cast<float>(config.confirmation.radius_m));
  UnconfirmedPixels unconfirmed;
  unconfirmed.mask.resize(record.size());
  for (std::size_t i = 0; i < record.size(); ++i)
    unconfirmed.mask[i] = needs_confirmation(i, record, masks, near);
  if (std::ranges::find(unconfirmed.mask, true) == unconfirmed.mask.end()) return {};
  unconfirmed.surfaces = find_surfaces(record, unconfirmed.surface);
  return unconfirmed;
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
      if (depth == 0 || depth < nearest || !is_on_surface(record, column, row, config)) continue;  // rule 2
      its_class = depth <= farthest ? PixelClass::kStatic : PixelClass::kFar;                  // rule 3
    }
}

void classify(KeyframeRecord& record, const DynamicMasks& masks, const MapperConfig& config) {
  for (std::size_t i = 0; i < record.size(); ++i) record.classes[i] = class_of(i, record, masks);
  record.unconfirmed = unconfirmed_pixels(record, masks, config);
}

PixelClasses resolve(const KeyframeRecord& record, const SceneHistory& history, const MapperConfig& config) {
  PixelClasses classes = record.classes;
  const auto confirmed = confirmed_surfaces(record, history.statics, config);
  for (std::size_t i = 0; i < record.unconfirmed.mask.size(); ++i)
    if (record.unconfirmed.mask[i])
      classes[i] =
          confirmed[record.unconfirmed.surface[i]] ? PixelClass::kStatic : PixelClass::kInvalid;  // rule 9
  std::ranges::replace(classes, PixelClass::kUnknown, PixelClass::kInvalid);  // rule 10
  const auto transient = transient_pixels(record, history, config, classes);
  for (std::size_t i = 0; i < transient.size(); ++i)
    if (transient[i]) classes[i] = PixelClass::kInvalid;  // rule 11
  return classes;
}

}  // namespace rds::mapper
