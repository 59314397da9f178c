// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace rds::tracker {

/// The cells of a picture whose features are not to be trusted; without cells: none.
class MovableMask {
 public:
  MovableMask() = default;
  /// @param cells  not 0 where something movable shows; not changed any more.
  MovableMask(cv::Mat1b cells, int cell_px)
      : cells_(std::move(cells)), cell_px_(cell_px), any_(cv::countNonZero(cells_) > 0) {}

  [[nodiscard]] bool any() const { return any_; }
  /// @param image_px  in the picture as the camera gives it (with distortion); outside it nothing is movable.
  [[nodiscard]] bool covers(const Eigen::Vector2f& image_px) const {
    if (!any_) return false;
    const int column = static_cast<int>(std::lround(image_px.x())) / cell_px_;
    const int row = static_cast<int>(std::lround(image_px.y())) / cell_px_;
    return column >= 0 && row >= 0 && column < cells_.cols && row < cells_.rows && cells_(row, column) != 0;
  }
  [[nodiscard]] const cv::Mat1b& cells() const { return cells_; }
  [[nodiscard]] int cell_px() const { return cell_px_; }

 private:
  cv::Mat1b cells_;
  int cell_px_ = 1;
  bool any_ = false;
};

}  // namespace rds::tracker
