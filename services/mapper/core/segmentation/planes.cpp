// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/planes.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace rds::mapper {
namespace {

constexpr double kPlaneDistanceM = 0.01;  // relief of walls and table tops, beside the noise of depth
constexpr int kCellPx = 8;                // side of a cell in sampled pixels
constexpr double kMinMeasured = 0.5;      // share of a cell's pixels
constexpr std::size_t kBlock = 9;         // cells, 3×3, that a plane begins with

using CellIndices = std::vector<std::size_t>;

/// Of a pixel from its plane at this depth.
double tolerance_m(double depth_m, const SegmentationConfig& config) {
  return kPlaneDistanceM + config.plane_noise * depth_m * depth_m;
}

/// The cells of a picture; free are those that are no part of a plane yet.
class Cells {
 public:
  Cells(const KeyframeRecord& record, const SegmentationConfig& config)
      : record_(record),
        config_(config),
        columns_((record.grid.width + kCellPx - 1) / kCellPx),
        rows_((record.grid.height + kCellPx - 1) / kCellPx),
        sums_(static_cast<std::size_t>(columns_ * rows_)),
        free_(sums_.size()) {
    for (std::size_t i = 0; i < record.size(); ++i)
      if (looks_static(record.classes[i])) sums_[cell_of(i)].add(record.point_in_camera(i).cast<double>());
    for (std::size_t i = 0; i < sums_.size(); ++i)
      free_[i] = sums_[i].count() >= kMinMeasured * kCellPx * kCellPx;
  }

  /// Middle cells of flat blocks, the flattest first.
  [[nodiscard]] CellIndices seeds() const {
    std::vector<std::pair<double, std::size_t>> flat;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      const auto block = free_around(i);
      if (block.size() < kBlock) continue;
      const PointSums points = sum(block);
      const double share = points.deviation_m(points.plane()) / limit_m(points);
      if (share < 1) flat.emplace_back(share, i);
    }
    std::ranges::sort(flat);
    CellIndices middles;
    for (const auto& [share, i] : flat) middles.push_back(i);
    return middles;
  }

  /// Takes the cells that are connected with a seed's block in one plane; none where other planes have some.
  CellIndices take_region(std::size_t seed) {
    CellIndices region = free_around(seed);
    if (region.size() < kBlock) return {};
    PointSums points = sum(region);
    for (const auto i : region) free_[i] = false;
    Plane plane = points.plane();
    for (std::size_t k = 0; k < region.size(); ++k)
      for (const auto i : free_around(region[k])) {
        if (!is_on(plane, sums_[i])) continue;
        free_[i] = false;
        region.push_back(i);
        points.add(sums_[i]);
        plane = points.plane();
      }
    return region;
  }

  void give_back(const CellIndices& cells) {
    for (const auto i : cells) free_[i] = true;
  }
  /// Drops the cells that a larger surface has taken.
  void keep_free(CellIndices& cells) const {
    std::erase_if(cells, [&](std::size_t i) { return !free_[i]; });
  }

  /// A region's plane with all its pixels; takes the free cells that lie on it, too.
  FlatSurface take_surface(const CellIndices& region) {
    FlatSurface surface{sum(region).plane(), {}};
    std::vector<bool> near(sums_.size(), false);
    const auto take = [&](std::size_t cell) {
      free_[cell] = false;
      for_block(cell, [&](std::size_t i) { near[i] = true; });
    };
    for (const auto i : region) take(i);
    for (std::size_t i = 0; i < sums_.size(); ++i)
      if (free_[i] && is_on(surface.plane, sums_[i])) take(i);
    for (std::size_t i = 0; i < record_.size(); ++i)
      if (near[cell_of(i)] && looks_static(record_.classes[i]) &&
          lies_on(surface.plane, record_.point_in_camera(i), config_))
        surface.pixels.push_back(i);
    return surface;
  }

 private:
  [[nodiscard]] std::size_t cell_of(std::size_t pixel) const {
    const auto width = static_cast<std::size_t>(record_.grid.width);
    return pixel / width / kCellPx * static_cast<std::size_t>(columns_) + pixel % width / kCellPx;
  }

  template <class Visit>
  void for_block(std::size_t middle, Visit visit) const {
    const int x = static_cast<int>(middle) % columns_;
    const int y = static_cast<int>(middle) / columns_;
    for (int v = std::max(0, y - 1); v <= std::min(rows_ - 1, y + 1); ++v)
      for (int u = std::max(0, x - 1); u <= std::min(columns_ - 1, x + 1); ++u)
        visit(static_cast<std::size_t>(v * columns_ + u));
  }
  [[nodiscard]] CellIndices free_around(std::size_t middle) const {
    CellIndices cells;
    for_block(middle, [&](std::size_t i) {
      if (free_[i]) cells.push_back(i);
    });
    return cells;
  }

  [[nodiscard]] PointSums sum(const CellIndices& cells) const {
    PointSums points;
    for (const auto i : cells) points.add(sums_[i]);
    return points;
  }
  /// Standard deviation that points on a plane may have: the tolerance is two of them.
  [[nodiscard]] double limit_m(const PointSums& points) const {
    return tolerance_m(points.mean().z(), config_) / 2;
  }
  [[nodiscard]] bool is_on(const Plane& plane, const PointSums& points) const {
    return points.deviation_m(plane) < limit_m(points);
  }

  const KeyframeRecord& record_;
  const SegmentationConfig& config_;
  int columns_;
  int rows_;
  std::vector<PointSums> sums_;
  std::vector<bool> free_;
};

}  // namespace

bool lies_on(const Plane& plane, const Eigen::Vector3f& point, const SegmentationConfig& config) {
  return std::abs(plane.distance_m(point.cast<double>())) < tolerance_m(double{point.z()}, config);
}

std::vector<FlatSurface> find_planes(const KeyframeRecord& record, const SegmentationConfig& config) {
  Cells cells(record, config);
  const double needed = kMinPlaneShare * static_cast<double>(record.size()) / (kCellPx * kCellPx);
  std::vector<CellIndices> regions;
  for (const auto seed : cells.seeds()) regions.push_back(cells.take_region(seed));
  for (const auto& region : regions) cells.give_back(region);
  std::ranges::stable_sort(regions, std::greater{}, [](const auto& r) { return r.size(); });
  std::vector<FlatSurface> surfaces;
  for (auto& region : regions) {
    cells.keep_free(region);
    if (static_cast<double>(region.size()) >= needed) surfaces.push_back(cells.take_surface(region));
  }
  return surfaces;
}

}  // namespace rds::mapper
