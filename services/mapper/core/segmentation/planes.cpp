// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/planes.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

namespace rds::mapper {
namespace {

constexpr int kCellPx = 8;            // side of a cell in sampled pixels
constexpr double kMinMeasured = 0.5;  // share of a cell's pixels
constexpr std::size_t kBlock = 9;     // cells, 3×3, that a plane begins with

using CellIndices = std::vector<std::size_t>;

/// Up to kBlock cells.
class Block {
 public:
  void push_back(std::size_t cell) { cells_[size_++] = cell; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const std::size_t* begin() const { return cells_.data(); }
  [[nodiscard]] const std::size_t* end() const { return cells_.data() + size_; }

 private:
  std::array<std::size_t, kBlock> cells_{};
  std::size_t size_ = 0;
};

/// The cells of a picture; free are those that are no part of a plane yet.
class Cells {
 public:
  Cells(const KeyframeRecord& record, const geometry::DepthNoise& noise)
      : record_(record),
        noise_(noise),
        columns_((record.grid.width + kCellPx - 1) / kCellPx),
        rows_((record.grid.height + kCellPx - 1) / kCellPx),
        sums_(static_cast<std::size_t>(columns_ * rows_)),
        free_(sums_.size()) {
    for (std::size_t cell = 0; cell < sums_.size(); ++cell) {
      PointSums points;
      for (int row = 0; row < rows_in(cell); ++row)
        for_row_of(cell, row, [&](std::size_t i) {
          if (looks_static(record.classes[i])) points.add(record.point_in_camera(i).cast<double>());
        });
      sums_[cell] = points;
    }
    for (std::size_t i = 0; i < sums_.size(); ++i)
      free_[i] = sums_[i].count() >= kMinMeasured * kCellPx * kCellPx;
  }

  /// Middle cells of flat blocks, the flattest first.
  [[nodiscard]] CellIndices seeds() const {
    std::vector<std::pair<double, std::size_t>> flat;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      const Block block = free_around(i);
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
    const Block block = free_around(seed);
    if (block.size() < kBlock) return {};
    CellIndices region(block.begin(), block.end());
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
    std::vector<std::uint8_t> near(sums_.size(), 0);
    const auto take = [&](std::size_t cell) {
      free_[cell] = false;
      for_block(cell, [&](std::size_t i) { near[i] = 1; });
    };
    for (const auto i : region) take(i);
    for (std::size_t i = 0; i < sums_.size(); ++i)
      if (free_[i] && is_on(surface.plane, sums_[i])) take(i);
    for (int row = 0; row < record_.grid.height; ++row)
      for (int column = 0; column < columns_; ++column) {
        const auto cell = static_cast<std::size_t>(row / kCellPx * columns_ + column);
        if (near[cell] == 0) continue;
        for_row_of(cell, row % kCellPx, [&](std::size_t i) {
          if (looks_static(record_.classes[i]) && lies_on(surface.plane, record_.point_in_camera(i), noise_))
            surface.pixels.push_back(i);
        });
      }
    return surface;
  }

 private:
  [[nodiscard]] int rows_in(std::size_t cell) const {
    return std::min(kCellPx, record_.grid.height - static_cast<int>(cell) / columns_ * kCellPx);
  }
  /// Calls visit(pixel) for one row of a cell's pixels.
  template <class Visit>
  void for_row_of(std::size_t cell, int row, Visit visit) const {
    const int x = static_cast<int>(cell) % columns_ * kCellPx;
    const int y = static_cast<int>(cell) / columns_ * kCellPx + row;
    const std::size_t first = record_.grid.index(x, y);
    const auto count = static_cast<std::size_t>(std::min(kCellPx, record_.grid.width - x));
    for (std::size_t i = first; i < first + count; ++i) visit(i);
  }

  template <class Visit>
  void for_block(std::size_t middle, Visit visit) const {
    const int x = static_cast<int>(middle) % columns_;
    const int y = static_cast<int>(middle) / columns_;
    for (int v = std::max(0, y - 1); v <= std::min(rows_ - 1, y + 1); ++v)
      for (int u = std::max(0, x - 1); u <= std::min(columns_ - 1, x + 1); ++u)
        visit(static_cast<std::size_t>(v * columns_ + u));
  }
  [[nodiscard]] Block free_around(std::size_t middle) const {
    Block cells;
    for_block(middle, [&](std::size_t i) {
      if (free_[i]) cells.push_back(i);
    });
    return cells;
  }

  template <class CellList>
  [[nodiscard]] PointSums sum(const CellList& cells) const {
    PointSums points;
    for (const auto i : cells) points.add(sums_[i]);
    return points;
  }
  /// Standard deviation that points on a plane may have: half of what one of them may be off.
  [[nodiscard]] double limit_m(const PointSums& points) const {
    return noise_.plane_tolerance_m(points.mean().z()) / 2;
  }
  [[nodiscard]] bool is_on(const Plane& plane, const PointSums& points) const {
    return points.deviation_m(plane) < limit_m(points);
  }

  const KeyframeRecord& record_;
  const geometry::DepthNoise& noise_;
  int columns_;
  int rows_;
  std::vector<PointSums> sums_;
  std::vector<bool> free_;
};

}  // namespace

std::vector<FlatSurface> find_planes(const KeyframeRecord& record, const geometry::DepthNoise& noise) {
  Cells cells(record, noise);
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
