// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/box_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

#include "common/dynamic_segmentation/cell_rows.hpp"

namespace rds::segmentation {
namespace {

/// Depth of an object: the median of what is measured in its box between its limits; their middle if nothing
/// is.
float depth_of(const ObjectRegion& box, const cv::Mat1f& depth_m) {
  std::vector<float> measured;
  for (int r = 0; r < depth_m.rows; ++r)
    std::copy_if(depth_m[r], depth_m[r] + depth_m.cols, std::back_inserter(measured),
                 [&](float z) { return z > 0 && z >= box.min_depth_m && z <= box.max_depth_m; });
  if (measured.empty()) return (box.min_depth_m + box.max_depth_m) / 2;
  const auto middle = measured.begin() + static_cast<std::ptrdiff_t>(measured.size() / 2);
  std::nth_element(measured.begin(), middle, measured.end());
  return *middle;
}

/// Log-odds by the box of the cells in it: the farther from the object in depth, the less likely a cell is a
/// part of it. Where a cell has more already, that stays.
void add_box(const cv::Mat1f& depth_m, float object_m, float sigma_m, const EvidenceModel& model,
             cv::Mat1f log_odds) {
  for (int r = 0; r < depth_m.rows; ++r) {
    const auto z = row_of(depth_m, r);
    const Eigen::ArrayXf near = (-0.5F * ((z - object_m) / sigma_m).square()).exp();
    const Eigen::ArrayXf p = model.unseen + (model.filled - model.unseen) * (z > 0).select(near, 1.0F);
    row_of(log_odds, r) = row_of(log_odds, r).max((p / (1 - p)).log());
  }
}

}  // namespace

cv::Rect cells_of(const geometry::Box2& box, const GridGeometry& grid) {
  const double cell = grid.cell_px();
  const int x0 = static_cast<int>(std::floor(box.x0 / cell));
  const int y0 = static_cast<int>(std::floor(box.y0 / cell));
  const int x1 = static_cast<int>(std::ceil(box.x1 / cell));
  const int y1 = static_cast<int>(std::ceil(box.y1 / cell));
  return cv::Rect(x0, y0, x1 - x0, y1 - y0) & cv::Rect({0, 0}, grid.size());
}

cv::Mat1f box_log_odds(const cv::Mat1f& depth_m, const GridGeometry& grid,
                       std::span<const ObjectRegion> boxes, const EvidenceModel& model) {
  cv::Mat1f result(grid.size(), log_odds_of(model.unseen));
  for (const ObjectRegion& box : boxes) {
    const cv::Rect cells = cells_of(box.box_px, grid);
    add_box(depth_m(cells), depth_of(box, depth_m(cells)), box.sigma_m, model, result(cells));
  }
  return result;
}

}  // namespace rds::segmentation
