// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/background.hpp"

#include <algorithm>
#include <optional>

namespace rds::segmentation {
namespace {

constexpr int kStride = 2;  // cells, between those that are asked for planes

}  // namespace

Background::Background(const PictureCells& picture, const GridGeometry& grid, const cv::Mat1b& unknown)
    : picture_(picture),
      surfaces_{picture.depth_m, grid},
      planes_(fit_planes(samples_outside(unknown), grid.noise())) {}

std::vector<SurfaceSample> Background::samples_outside(const cv::Mat1b& unknown) const {
  const cv::Mat1f& depth_m = picture_.depth_m;
  std::vector<SurfaceSample> samples;
  samples.reserve(depth_m.total() / (kStride * kStride));
  for (int r = 0; r < depth_m.rows; r += kStride)
    for (int c = 0; c < depth_m.cols; c += kStride)
      if (depth_m(r, c) > 0 && (unknown(r, c) == 0 || picture_.stable(r, c) != 0))
        samples.push_back({surfaces_.point(c, r), surfaces_.normal(c, r)});
  return samples;
}

bool Background::shows_at(const cv::Point& cell) const {
  if (!(picture_.depth_m(cell) > 0)) return false;
  const Eigen::Vector3f p = surfaces_.point(cell.x, cell.y);
  std::optional<Eigen::Vector3f> normal;
  return std::ranges::any_of(planes_, [&](const BackgroundPlane& plane) {
    if (!is_near(plane, p, surfaces_.grid.noise())) return false;
    if (!normal) normal = surfaces_.normal(cell.x, cell.y);
    return is_parallel(plane, *normal);
  });
}

}  // namespace rds::segmentation
