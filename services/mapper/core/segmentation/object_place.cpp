// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/object_place.hpp"

#include <algorithm>
#include <cmath>

namespace rds::mapper {
namespace {

constexpr double kInnerShare = 0.6;    // part of the box, about its centre, in which the object surely lies
constexpr float kPersonM = 0.35F;      // a person's surface lies so near to his depth
constexpr float kThingM = 0.5F;        // how far a small static object reaches behind its depth
constexpr float kBeforeM = 0.14F;      // and before it, for its depth: things stand before tables
constexpr float kSigmaPerSide = 0.4F;  // standard deviation of a static object's depths, by its larger side
constexpr float kLeastSigmaM = 0.15F;
constexpr std::size_t kMinDepths = 20;  // fewer say nothing about the object

struct DepthInterval {
  float min_m;
  float max_m;
};

/// The box in sampled pixels, inside the picture.
cv::Rect sampled_rect(const geometry::Box2& box, const KeyframeRecord& record) {
  const double s = record.grid.stride;
  const auto first = [&](double px) { return static_cast<int>(std::ceil(px / s)); };
  const cv::Rect rect(cv::Point(first(box.x0), first(box.y0)), cv::Point(first(box.x1), first(box.y1)));
  return rect & cv::Rect(0, 0, record.grid.width, record.grid.height);
}

geometry::Box2 inner_part(const geometry::Box2& box) {
  const double dx = box.width() * (1 - kInnerShare) / 2;
  const double dy = box.height() * (1 - kInnerShare) / 2;
  return {box.x0 + dx, box.y0 + dy, box.x1 - dx, box.y1 - dy};
}

std::vector<float> depths_in(const cv::Rect& rect, const DepthInterval& limits,
                             const KeyframeRecord& record) {
  std::vector<float> depths;
  for (int y = rect.y; y < rect.y + rect.height; ++y)
    for (int x = rect.x; x < rect.x + rect.width; ++x) {
      const auto i = record.grid.index(x, y);
      const float d = record.depth_m(i);
      const bool used =
          record.classes[i] != PixelClass::kInvalid && record.classes[i] != PixelClass::kUnknown;
      if (d > 0 && used && d >= limits.min_m && d <= limits.max_m) depths.push_back(d);
    }
  return depths;
}

/// Depths between which the object must lie, from its depth or 3-D box; all depths if neither is known.
DepthInterval depth_limits(const LabelledBox& box, const KeyframeRecord& record) {
  if (box.depth_m > 0 && std::isfinite(box.depth_m)) return {box.depth_m - kPersonM, box.depth_m + kPersonM};
  if (!box.box_in_map) return {0, 100};
  DepthInterval interval{100, 0};
  for (int corner = 0; corner < 8; ++corner) {
    const auto& b = *box.box_in_map;
    const Eigen::Vector3d p(corner & 1 ? b.max.x() : b.min.x(), corner & 2 ? b.max.y() : b.min.y(),
                            corner & 4 ? b.max.z() : b.min.z());
    const auto z = static_cast<float>((record.map_from_camera.inverse() * p).z());
    interval = {std::min(interval.min_m, z), std::max(interval.max_m, z)};
  }
  return {interval.min_m - kPersonM / 2, interval.max_m + kPersonM / 2};
}

/// Depth of the object's visible side [m]; 0 if too little was measured.
float object_depth(std::vector<float> depths) {
  if (depths.size() < kMinDepths) return 0;
  const auto median = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  const auto third = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 3);
  std::nth_element(depths.begin(), median, depths.end());
  std::nth_element(depths.begin(), third, median);
  return (*median + *third) / 2;
}

/// Depth of the object in a box, from the box's inner part if that shows enough [m]; 0 if unknown.
float depth_in_box(const geometry::Box2& box_px, const DepthInterval& limits, const KeyframeRecord& record) {
  const float inner = object_depth(depths_in(sampled_rect(inner_part(box_px), record), limits, record));
  return inner > 0 ? inner : object_depth(depths_in(sampled_rect(box_px, record), limits, record));
}

}  // namespace

std::optional<geometry::Box2> image_box(const LabelledBox& box, const KeyframeRecord& record) {
  if (box.box_px.area() > 0) {
    const auto clipped = box.box_px.clipped(record.grid.camera.width, record.grid.camera.height);
    const bool finite = std::isfinite(clipped.x0 + clipped.y0 + clipped.x1 + clipped.y1);
    return finite && clipped.area() > 0 ? std::optional(clipped) : std::nullopt;
  }
  if (!box.box_in_map || !box.box_in_map->min.allFinite() || !box.box_in_map->max.allFinite())
    return std::nullopt;
  return geometry::project(*box.box_in_map, record.map_from_camera.inverse(), record.grid.camera);
}

std::optional<segmentation::ObjectRegion> object_place(const KeyframeRecord& record, const LabelledBox& box) {
  const auto px = image_box(box, record);
  if (!px) return std::nullopt;
  const auto limits = depth_limits(box, record);
  const float depth = depth_in_box(*px, limits, record);
  if (depth <= 0) return std::nullopt;
  const bool has_extent = box.box_in_map && !(box.depth_m > 0);
  if (box.movable && has_extent) return segmentation::ObjectRegion{*px, limits.min_m, limits.max_m};
  if (box.movable) return segmentation::ObjectRegion{*px, depth - kPersonM, depth + kPersonM};
  const double side_px = std::max(px->width(), px->height());
  const float side_m = static_cast<float>(side_px / record.grid.camera.fx) * depth;
  const float sigma_m = std::max(kLeastSigmaM, kSigmaPerSide * side_m);
  if (has_extent) return segmentation::ObjectRegion{*px, limits.min_m, limits.max_m, sigma_m};
  return segmentation::ObjectRegion{*px, depth - kBeforeM, depth + std::max(kThingM, side_m / 2), sigma_m};
}

}  // namespace rds::mapper
