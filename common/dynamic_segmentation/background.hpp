// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/dynamic_segmentation/plane_fitting.hpp"
#include "common/dynamic_segmentation/surfaces.hpp"

namespace rds::segmentation {

/// The planes of a picture that go on outside all unknown parts: a table, a wall, the floor. Cells are asked
/// one by one, as few of them matter. Picture and grid must outlive it.
class Background {
 public:
  /// @param unknown  not 0 where something movable may show. Planes are fitted to the other cells, and to
  /// stable ones.
  Background(const PictureCells& picture, const GridGeometry& grid, const cv::Mat1b& unknown);

  [[nodiscard]] bool shows_at(const cv::Point& cell) const;

 private:
  [[nodiscard]] std::vector<SurfaceSample> samples_outside(const cv::Mat1b& unknown) const;

  const PictureCells& picture_;
  SurfaceCells surfaces_;
  std::vector<BackgroundPlane> planes_;
};

}  // namespace rds::segmentation
