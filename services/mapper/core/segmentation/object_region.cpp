// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/object_region.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace rds::mapper {
namespace {

constexpr double kInnerShare = 0.6;     // part of the box, about its centre, in which the object surely lies
constexpr int kMarginPx = 4;            // narrow: nothing may be added to a static object
constexpr double kStaticBefore = 0.4;   // share of kHalfDepthM: things stand before tables
constexpr std::size_t kMinDepths = 20;  // fewer say nothing about the object
constexpr double kMinInside = 0.05;     // share of a connected part that lies in the box as it was detected

struct DepthInterval {
  float min_m;
  float max_m;
};

/// The box in sampled pixels, widened, inside the picture.
cv::Rect sampled_rect(const geometry::Box2& box, double margin_px, const KeyframeRecord& record) {
  const double s = record.grid.stride;
  const auto low = [&](double v) { return static_cast<int>(std::ceil((v - margin_px) / s)); };
  const auto high = [&](double v) { return static_cast<int>(std::ceil((v + margin_px) / s)); };
  const cv::Rect rect(cv::Point(low(box.x0), low(box.y0)), cv::Point(high(box.x1), high(box.y1)));
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
  const auto half = static_cast<float>(kHalfDepthM);
  if (box.depth_m > 0 && std::isfinite(box.depth_m)) return {box.depth_m - half, box.depth_m + half};
  if (!box.box_in_map) return {0, 100};
  DepthInterval interval{100, 0};
  for (int corner = 0; corner < 8; ++corner) {
    const auto& b = *box.box_in_map;
    const Eigen::Vector3d p(corner & 1 ? b.max.x() : b.min.x(), corner & 2 ? b.max.y() : b.min.y(),
                            corner & 4 ? b.max.z() : b.min.z());
    const auto z = static_cast<float>((record.map_from_camera.inverse() * p).z());
    interval = {std::min(interval.min_m, z), std::max(interval.max_m, z)};
  }
  return {interval.min_m - half / 2, interval.max_m + half / 2};
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
  const float inner = object_depth(depths_in(sampled_rect(inner_part(box_px), 0, record), limits, record));
  return inner > 0 ? inner : object_depth(depths_in(sampled_rect(box_px, 0, record), limits, record));
}

/// How far an object reaches behind its depth [m]: of a large static one mostly the front is seen.
float reach_behind(const LabelledBox& box, const geometry::Box2& box_px, float depth_m,
                   const KeyframeRecord& record) {
  const auto half = static_cast<float>(kHalfDepthM);
  const double side_m = std::max(box_px.width(), box_px.height()) * depth_m / record.grid.camera.fx;
  return box.movable ? half : std::max(half, static_cast<float>(side_m / 2));
}

/// And before it [m].
float reach_before(const LabelledBox& box) {
  return static_cast<float>(box.movable ? kHalfDepthM : kStaticBefore * kHalfDepthM);
}

cv::Mat near_depth(const cv::Rect& rect, float depth_m, float before_m, float behind_m,
                   const KeyframeRecord& record) {
  cv::Mat near(rect.size(), CV_8U, cv::Scalar(0));
  for (int y = 0; y < rect.height; ++y)
    for (int x = 0; x < rect.width; ++x) {
      const auto i = record.grid.index(rect.x + x, rect.y + y);
      const float behind = record.depth_m(i) - depth_m;
      const bool inside = record.depth_tenth_mm[i] != 0 && behind >= -before_m && behind <= behind_m;
      near.at<std::uint8_t>(y, x) = inside ? 1 : 0;
    }
  return near;
}

/// Of each connected part of `near`: whether enough of it lies in the box.
std::vector<bool> parts_of_object(const cv::Mat& parts, int count, const cv::Rect& inside) {
  std::vector<int> area(static_cast<std::size_t>(count), 0);
  std::vector<int> area_inside(static_cast<std::size_t>(count), 0);
  for (int y = 0; y < parts.rows; ++y)
    for (int x = 0; x < parts.cols; ++x) {
      const auto part = static_cast<std::size_t>(parts.at<int>(y, x));
      ++area[part];
      if (inside.contains({x, y})) ++area_inside[part];
    }
  std::vector<bool> of_object(area.size(), false);  // part 0 is the background
  for (std::size_t part = 1; part < area.size(); ++part)
    of_object[part] = area_inside[part] > 0 && area_inside[part] >= kMinInside * area[part];
  return of_object;
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

std::optional<ObjectPlace> object_place(const KeyframeRecord& record, const LabelledBox& box) {
  const auto box_px = image_box(box, record);
  if (!box_px) return std::nullopt;
  const auto limits = depth_limits(box, record);
  const float depth = depth_in_box(*box_px, limits, record);
  if (depth <= 0) return std::nullopt;
  const double margin = kMarginPx;
  const bool has_extent = box.box_in_map && !(box.depth_m > 0);
  return ObjectPlace{{box_px->x0 - margin, box_px->y0 - margin, box_px->x1 + margin, box_px->y1 + margin},
                     has_extent ? limits.min_m : depth - reach_before(box),
                     has_extent ? limits.max_m : depth + reach_behind(box, *box_px, depth, record)};
}

std::vector<std::size_t> object_region(const KeyframeRecord& record, const LabelledBox& box) {
  const auto box_px = image_box(box, record);
  if (!box_px) return {};
  const float depth = depth_in_box(*box_px, depth_limits(box, record), record);
  if (depth <= 0) return {};

  const cv::Rect wide = sampled_rect(*box_px, kMarginPx, record);
  cv::Mat parts;
  const int count = cv::connectedComponents(
      near_depth(wide, depth, reach_before(box), reach_behind(box, *box_px, depth, record), record), parts, 8,
      CV_32S);
  const auto of_object = parts_of_object(parts, count, sampled_rect(*box_px, 0, record) - wide.tl());
  std::vector<std::size_t> pixels;
  for (int y = 0; y < wide.height; ++y)
    for (int x = 0; x < wide.width; ++x)
      if (of_object[static_cast<std::size_t>(parts.at<int>(y, x))])
        pixels.push_back(record.grid.index(wide.x + x, wide.y + y));
  return pixels;
}

}  // namespace rds::mapper
