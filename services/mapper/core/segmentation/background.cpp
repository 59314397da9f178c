// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/background.hpp"

#include <algorithm>
#include <array>

#include <Eigen/Geometry>

#include "services/mapper/core/segmentation/planes.hpp"

namespace rds::mapper {
namespace {

constexpr double kWiderThanAPersonM = 0.16;  // standard deviation along the narrower side: 0.55 m
constexpr float kParallel = 0.9F;            // cosine between a pixel's normal and its plane's
constexpr int kToNeighbour = 3;              // sampled pixels, between which a normal is measured

/// 1 for each pixel in one of the boxes.
std::vector<std::uint8_t> pixels_in(std::span<const geometry::Box2> boxes, const PixelGrid& grid) {
  std::vector<std::uint8_t> inside(static_cast<std::size_t>(grid.width) *
                                   static_cast<std::size_t>(grid.height));
  cv::Mat1b picture(grid.height, grid.width, inside.data());
  for (const geometry::Box2& box : boxes) picture(grid.inside(box)) = 1;
  return inside;
}

bool goes_on_outside(const FlatSurface& surface, const KeyframeRecord& record,
                     const std::vector<std::uint8_t>& in_boxes) {
  PointSums outside;
  for (const auto i : surface.pixels)
    if (in_boxes[i] == 0 && !is_dynamic(record, i)) outside.add(record.point_in_camera(i).cast<double>());
  return outside.count() >= kMinPlaneShare * static_cast<double>(record.size()) &&
         outside.narrow_deviation_m() >= kWiderThanAPersonM;
}

/// True where the normal at a pixel is that of the plane: the plane's pixels include those of a person who
/// stands in it.
bool lies_along(const Plane& plane, const KeyframeRecord& record, std::size_t pixel, int column, int row) {
  if (std::min(column, row) < kToNeighbour || column + kToNeighbour >= record.grid.width ||
      row + kToNeighbour >= record.grid.height)
    return false;
  const auto aside = static_cast<std::size_t>(kToNeighbour);
  const std::size_t down = aside * static_cast<std::size_t>(record.grid.width);
  const std::array around{pixel + aside, pixel - aside, pixel + down, pixel - down};
  if (std::ranges::any_of(around, [&](std::size_t i) { return !looks_static(record.classes[i]); }))
    return false;
  const auto between = [&](std::size_t a, std::size_t b) -> Eigen::Vector3f {
    return record.point_in_camera(a) - record.point_in_camera(b);
  };
  const Eigen::Vector3f normal = between(around[0], around[1]).cross(between(around[2], around[3]));
  return std::abs(normal.dot(plane.normal.cast<float>())) > kParallel * normal.norm();
}

}  // namespace

std::vector<std::uint8_t> find_background(const KeyframeRecord& record,
                                          std::span<const geometry::Box2> movable,
                                          const geometry::DepthNoise& noise) {
  if (movable.empty()) return {};
  const auto in_boxes = pixels_in(movable, record.grid);
  std::vector<std::uint8_t> background(record.size(), 0);
  for (const FlatSurface& surface : find_planes(record, noise)) {
    if (!goes_on_outside(surface, record, in_boxes)) continue;
    record.grid.for_each(surface.pixels, [&](std::size_t i, int column, int row) {
      if (lies_along(surface.plane, record, i, column, row)) background[i] = 1;
    });
  }
  return background;
}

}  // namespace rds::mapper
