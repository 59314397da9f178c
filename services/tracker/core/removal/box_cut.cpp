// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/removal/box_cut.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "services/tracker/core/removal/surfaces.hpp"

namespace rds::tracker {
namespace {

constexpr double kHardlyMeasured = 0.3;  // share of a box's cells that have a depth
constexpr double kReachM = 0.15;         // how far beyond its predicted box an object is looked for
constexpr double kMinComponent = 0.35;   // of the largest surface in a box; smaller ones are not the object's
constexpr double kThicknessM = 0.25;     // in front of and behind what has moved
constexpr int kHoleRadius = 3;           // cells around a cell without depth that are asked

cv::Rect cells_of(const geometry::Box2& box, const GridGeometry& grid, double margin_px) {
  const double cell = grid.cell_px();
  const int x0 = static_cast<int>(std::floor((box.x0 - margin_px) / cell));
  const int y0 = static_cast<int>(std::floor((box.y0 - margin_px) / cell));
  const int x1 = static_cast<int>(std::ceil((box.x1 + margin_px) / cell));
  const int y1 = static_cast<int>(std::ceil((box.y1 + margin_px) / cell));
  return cv::Rect(x0, y0, x1 - x0, y1 - y0) & cv::Rect({0, 0}, grid.size());
}

/// Where the depths of a thing in these cells can be, that far around them.
GrowthLimits around(const geometry::Box2& box, const GridGeometry& grid, double margin_m,
                    const MovableRegion& region) {
  const double middle_m = std::max(0.3, (region.min_depth_m + region.max_depth_m) / 2.0);
  return {cells_of(box, grid, grid.camera().fx * margin_m / middle_m), region.min_depth_m,
          region.max_depth_m};
}

void mark_box(Foreground& picture, const GridGeometry& grid, const MovableRegion& region, cv::Mat1b& mask) {
  const cv::Rect box = cells_of(region.box_px, grid, 0);
  if (box.empty()) return;
  const cv::Mat1f in_box = picture.depth_m()(box);
  if (cv::countNonZero(in_box) < kHardlyMeasured * box.area()) mask(box).setTo(255, in_box == 0);
  const GrowthLimits reach = around(region.box_px, grid, kReachM, region);
  const cv::Mat1f& in_front_m = picture.in_front_m(reach.cells);
  const auto surfaces = surfaces_within(in_front_m, around(region.box_px, grid, 0, region));
  for (const auto& surface : surfaces) {
    if (static_cast<double>(surface.size()) < kMinComponent * static_cast<double>(surfaces[0].size())) break;
    for (const cv::Point& cell : surface) mask(cell) = 255;
    grow_surface(in_front_m, reach, surface, mask);
  }
}

}  // namespace

const cv::Mat1f& Foreground::in_front_m(const cv::Rect& cells) {
  for (int r = cells.y; r < cells.br().y; ++r) {
    const float* depth_m = picture_.depth_m[r];
    float* in_front_m = in_front_m_[r];
    for (int c = cells.x; c < cells.br().x; ++c)
      if (in_front_m[c] == kNotAsked) in_front_m[c] = background_.shows({c, r}) ? 0 : depth_m[c];
  }
  return in_front_m_;
}

void mark_boxes(Foreground& picture, const GridGeometry& grid, std::span<const MovableRegion> regions,
                cv::Mat1b& mask) {
  for (const MovableRegion& region : regions) mark_box(picture, grid, region, mask);
}

void mark_moved(Foreground& picture, const GridGeometry& grid, const std::vector<cv::Point>& cells,
                cv::Mat1b& mask) {
  std::vector<float> depths;
  depths.reserve(cells.size());
  for (const cv::Point& cell : cells) depths.push_back(picture.depth_m()(cell));
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  const cv::Rect box = cv::boundingRect(cells);
  const int px = grid.cell_px();
  const MovableRegion region{{static_cast<double>(box.x * px), static_cast<double>(box.y * px),
                              static_cast<double>(box.br().x * px), static_cast<double>(box.br().y * px)},
                             static_cast<float>(*middle - kThicknessM),
                             static_cast<float>(*middle + kThicknessM)};
  for (const cv::Point& cell : cells) mask(cell) = 255;
  const GrowthLimits reach = around(region.box_px, grid, kReachM, region);
  grow_surface(picture.in_front_m(reach.cells), reach, cells, mask);
}

void fill_boxes(const GridGeometry& grid, std::span<const MovableRegion> regions, cv::Mat1b& mask) {
  for (const MovableRegion& region : regions) mask(cells_of(region.box_px, grid, 0)).setTo(255);
}

void close_and_widen(const cv::Mat1f& depth_m, cv::Mat1b& mask) {
  const cv::Size window(2 * kHoleRadius + 1, 2 * kHoleRadius + 1);
  cv::Mat1b known;
  cv::compare(depth_m, 0, known, cv::CMP_GT);
  cv::Mat1f known_around;
  cv::Mat1f marked_around;
  cv::boxFilter(known, known_around, CV_32F, window, {-1, -1}, false);
  cv::boxFilter(mask & known, marked_around, CV_32F, window, {-1, -1}, false);
  mask.setTo(255, (depth_m == 0) & (marked_around * 2 > known_around) & (known_around > 0));
  cv::dilate(mask, mask, cv::Mat());
}

}  // namespace rds::tracker
