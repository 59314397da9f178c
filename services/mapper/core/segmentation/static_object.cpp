// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/static_object.hpp"

#include <algorithm>

namespace rds::mapper {
namespace {

constexpr double kMostly = 0.5;   // share of a segment's pixels in the object's place
constexpr double kOneSide = 0.9;  // share of the object's other pixels on one side of a plane that bounds it
constexpr double kStandsOut = 0.1;  // share of the object's pixels off the plane; with less it is flush

bool overlap(const geometry::Box2& a, const geometry::Box2& b) {
  return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

bool lies_in(const ObjectPlace& place, const Segment& segment, const KeyframeRecord& record) {
  double inside = 0;
  record.grid.for_each(segment.pixels, [&](std::size_t i, int column, int row) {
    inside += place.is_at_depth(record.depth_m(i)) && place.is_in_box(record.grid, column, row) ? 1 : 0;
  });
  return inside >= kMostly * static_cast<double>(segment.pixels.size());
}

/// Takes the pixels on a plane away, if the others lie on one side of it: a plane that passes through an
/// object, as that of a table top through the chair before it, does not bound it.
void remove_support(const Plane& plane, const KeyframeRecord& record, const geometry::DepthNoise& noise,
                    std::vector<std::size_t>& pixels) {
  std::vector<std::size_t> others;
  double above = 0;
  for (const auto i : pixels) {
    const Eigen::Vector3f point = record.point_in_camera(i);
    if (lies_on(plane, point, noise)) continue;
    others.push_back(i);
    above += plane.distance_m(point.cast<double>()) > 0 ? 1 : 0;
  }
  const auto count = static_cast<double>(others.size());
  const bool bounds = std::max(above, count - above) >= kOneSide * count;
  if (bounds && count >= kStandsOut * static_cast<double>(pixels.size())) pixels = std::move(others);
}

bool is_flush(const std::vector<std::size_t>& region, std::span<const Plane> planes,
              const KeyframeRecord& record, const geometry::DepthNoise& noise) {
  return std::ranges::any_of(planes, [&](const Plane& plane) {
    const auto out = std::ranges::count_if(
        region, [&](std::size_t i) { return !lies_on(plane, record.point_in_camera(i), noise); });
    return static_cast<double>(out) < kStandsOut * static_cast<double>(region.size());
  });
}

}  // namespace

StaticObject static_object(const KeyframeRecord& record, const LabelledBox& box,
                           std::span<const Segment> segments, const MapperConfig& config) {
  const geometry::DepthNoise& noise = config.sampling.depth_noise;
  const auto place = object_place(record, box);
  if (!place) return {};
  std::vector<std::uint8_t> is_object(record.size(), 0);
  const auto region = object_region(record, box);
  for (const auto i : region) is_object[i] = 1;
  std::vector<Plane> elsewhere;
  for (const auto& segment : segments) {
    if (!overlap(segment.box_px, place->box_px)) continue;
    const bool own = lies_in(*place, segment, record);
    record.grid.for_each(segment.pixels, [&](std::size_t i, int column, int row) {
      is_object[i] = own && place->is_in_box(record.grid, column, row);
    });
    if (!own && segment.plane) elsewhere.push_back(*segment.plane);
  }
  StaticObject object{{}, is_flush(region, elsewhere, record, noise)};
  if (object.flush)
    for (const auto i : region) is_object[i] = 1;
  const cv::Rect box_around = record.grid.inside(place->box_px);
  const std::size_t end = record.grid.index(0, box_around.y + box_around.height);
  for (std::size_t i = record.grid.index(0, box_around.y); i < end; ++i)
    if (is_object[i] != 0 && looks_static(record.classes[i])) object.pixels.push_back(i);
  for (const auto& plane : elsewhere) remove_support(plane, record, noise, object.pixels);
  return object;
}

}  // namespace rds::mapper
