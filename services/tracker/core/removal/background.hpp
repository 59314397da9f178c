// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/tracker/core/removal/plane_fitting.hpp"
#include "services/tracker/core/removal/surfaces.hpp"

namespace rds::tracker {

/// What of a picture is no movable thing: what has stood still for long, and planes that go on outside all
/// unknown parts: a table, a wall, the floor. Cells are asked one by one, as few of them matter. Picture and
/// grid must outlive it.
class Background {
 public:
  /// @param unknown  not 0 where something movable may show: in boxes, and where something has moved. Planes
  /// are fitted to the other cells, and to stable ones.
  Background(const PictureCells& picture, const GridGeometry& grid, const cv::Mat1b& unknown);

  [[nodiscard]] bool shows(const cv::Point& cell) const { return shows(cell, false); }
  /// The same without planes that are no wider than a person.
  [[nodiscard]] bool shows_wide(const cv::Point& cell) const { return shows(cell, true); }

 private:
  [[nodiscard]] bool shows(const cv::Point& cell, bool wide) const;
  [[nodiscard]] std::vector<SurfaceSample> samples_outside(const cv::Mat1b& unknown) const;

  const PictureCells& picture_;
  SurfaceCells surfaces_;
  std::vector<BackgroundPlane> planes_;
};

}  // namespace rds::tracker
