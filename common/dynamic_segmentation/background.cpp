// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/background.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace rds::segmentation {
namespace {

constexpr int kStride = 2;  // cells, between those that are asked for planes

}  // namespace

std::vector<BackgroundPlane> background_planes(const PictureCells& picture, const GridGeometry& grid,
                                               const cv::Mat1b& unknown) {
  const cv::Mat1f& depth_m = picture.depth_m;
  const SurfaceCells surfaces{depth_m, grid};
  std::vector<SurfaceSample> samples;
  samples.reserve(depth_m.total() / (kStride * kStride));
  for (int r = 0; r < depth_m.rows; r += kStride)
    for (int c = 0; c < depth_m.cols; c += kStride)
      if (depth_m(r, c) > 0 && (unknown(r, c) == 0 || picture.stable(r, c) != 0))
        samples.push_back({surfaces.point(c, r), surfaces.normal(c, r)});
  return fit_planes(std::move(samples), grid.noise());
}

bool Background::shows_at(const cv::Point& cell) const {
  if (!(surfaces_.depth_m(cell) > 0)) return false;
  const Eigen::Vector3f p = surfaces_.point(cell.x, cell.y);
  std::optional<Eigen::Vector3f> normal;
  return std::ranges::any_of(planes_, [&](const BackgroundPlane& plane) {
    if (!is_near(plane, p, surfaces_.grid.noise())) return false;
    if (!normal) normal = surfaces_.normal(cell.x, cell.y);
    return is_parallel(plane, *normal);
  });
}

}  // namespace rds::segmentation
