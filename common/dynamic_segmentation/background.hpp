// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/dynamic_segmentation/plane_fitting.hpp"
#include "common/dynamic_segmentation/surfaces.hpp"

namespace rds::segmentation {

/// The planes of a picture that go on outside all unknown parts: a table, a wall, the floor.
/// @param unknown  not 0 where something movable may show. Planes are fitted to the other cells, and to
/// stable ones.
std::vector<BackgroundPlane> background_planes(const PictureCells& picture, const GridGeometry& grid,
                                               const cv::Mat1b& unknown);

/// Which cells show one of some planes; they are asked one by one, as few of them matter. Depth [m], grid and
/// planes must outlive it.
class Background {
 public:
  Background(const cv::Mat1f& depth_m, const GridGeometry& grid, const std::vector<BackgroundPlane>& planes)
      : surfaces_{depth_m, grid}, planes_(planes) {}

  [[nodiscard]] bool shows_at(const cv::Point& cell) const;

 private:
  SurfaceCells surfaces_;
  const std::vector<BackgroundPlane>& planes_;
};

}  // namespace rds::segmentation
