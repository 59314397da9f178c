// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/depth_aligner.hpp"

#include "services/tracker/core/pose/depth_alignment.hpp"

namespace rds::tracker {

std::optional<geometry::Pose> DepthAligner::estimate(const DepthView& view,
                                                     const geometry::Pose& guess) const {
  const GridGeometry& grid = *view.grid;
  if (!previous_ || previous_->camera != grid.camera()) return std::nullopt;
  const auto& [depth_m, movable, camera, map_from_camera] = *previous_;
  const cv::Mat1b is_static =
      movable.empty() ? cv::Mat1b(grid.size(), std::uint8_t{255}) : cv::Mat1b(movable == 0);
  const EarlierView before{{depth_m, movable, grid, map_from_camera},
                           {depth_m, is_static, grid, map_from_camera}};
  return align_depth(before, view.depth_m, grid, guess);
}

void DepthAligner::set_previous(const DepthView& view, const geometry::Pose& map_from_camera) {
  previous_ = Previous{view.depth_m, view.movable, view.grid->camera(), map_from_camera};
}

}  // namespace rds::tracker
