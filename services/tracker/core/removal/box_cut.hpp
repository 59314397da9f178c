// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "services/tracker/core/removal/background.hpp"
#include "services/tracker/core/removal/movable_region.hpp"

namespace rds::tracker {

/// The depth of a picture without its background, computed for the cells that are asked for only.
class Foreground {
 public:
  /// Both must outlive it.
  Foreground(const PictureCells& picture, const Background& background)
      : picture_(picture), background_(background), in_front_m_(picture.depth_m.size(), kNotAsked) {}

  /// Depth [m] of the picture.
  [[nodiscard]] const cv::Mat1f& depth_m() const { return picture_.depth_m; }
  /// The same with 0 where background shows; right within these cells only.
  const cv::Mat1f& in_front_m(const cv::Rect& cells);

 private:
  static constexpr float kNotAsked = -1;

  const PictureCells& picture_;
  const Background& background_;
  cv::Mat1f in_front_m_;
};

/// Marks (255) in `mask` the objects in boxes: of each box the foreground surfaces within its depth interval,
/// and what they are connected with up to 0.15 m beyond the box. Cells without depth are marked if less than
/// 30 % of the box has depth.
void mark_boxes(Foreground& picture, const GridGeometry& grid, std::span<const MovableRegion> regions,
                cv::Mat1b& mask);

/// Marks the cells of something that has moved, and what they are connected with up to 0.15 m around them.
void mark_moved(Foreground& picture, const GridGeometry& grid, const std::vector<cv::Point>& cells,
                cv::Mat1b& mask);

/// Marks whole boxes, whatever their depth.
void fill_boxes(const GridGeometry& grid, std::span<const MovableRegion> regions, cv::Mat1b& mask);

/// Marks cells without measurement most of whose measured neighbours are marked, then a rim of one cell
/// around all that is marked.
void close_and_widen(const cv::Mat1f& depth_m, cv::Mat1b& mask);

}  // namespace rds::tracker
