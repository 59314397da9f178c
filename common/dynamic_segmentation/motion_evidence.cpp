// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/motion_evidence.hpp"

#include <algorithm>
#include <limits>

#include <opencv2/imgproc.hpp>

namespace rds::segmentation {
namespace {

constexpr float kNothing = std::numeric_limits<float>::max();
constexpr Eigen::Index kBatch = GridGeometry::Numbers::MaxRowsAtCompileTime;
constexpr int kThinnest = 5;        // cells across, of a thing
constexpr int kWitnesses = 2;       // earlier pictures
// Nearer than what stood there before, 1 m away; grows with depth squared. Twice a surface's own steps, which
// is ten times and more what noise makes (docs/decisions/depth-noise.md).
constexpr float kStepM = 0.1F;
constexpr float kSameShare = 0.4F;  // of kStepM: so near is the same surface
constexpr double kMaxShare = 0.4;   // of what can be judged; more is an error of the pose

/// Depth [m] of what an earlier picture saw, where it shows now; kNothing elsewhere.
cv::Mat1f seen_from_here(const SeenCells& past, const GridGeometry& grid,
                         const geometry::Pose& camera_from_map) {
  const Eigen::Isometry3f here_from_past = (camera_from_map * past.map_from_camera).cast<float>();
  const Eigen::Matrix3f turn = here_from_past.linear();
  const Eigen::Vector3f shift = here_from_past.translation();
  cv::Mat1f here(grid.size(), kNothing);
  float* shown = here.ptr<float>();
  for (Eigen::Index first = 0; first < past.points.rows(); first += kBatch) {
    const auto p = past.points.middleRows(first, std::min(kBatch, past.points.rows() - first));
    const auto along = [&](int axis) {
      return shift(axis) + (turn(axis, 0) * p.col(0) + turn(axis, 1) * p.col(1) + turn(axis, 2) * p.col(2));
    };
    const GridGeometry::Numbers z = along(2);
    const GridGeometry::Cells cells = grid.indices_of(along(0), along(1), z);
    for (Eigen::Index i = 0; i < z.size(); ++i)
      if (cells[i] >= 0) shown[cells[i]] = std::min(shown[cells[i]], z[i]);
  }
  return here;
}

/// Adds what one earlier picture says. @param before  of it, seen_from_here().
void judge(const cv::Mat1f& depth_m, const cv::Mat1f& before, MotionEvidence& evidence) {
  cv::Mat1f nearest;
  cv::erode(before, nearest, cv::Mat());
  cv::Mat1f farthest = before.clone();
  farthest.setTo(0, before == kNothing);
  cv::dilate(farthest, farthest, cv::Mat());
  for (int i = 0; i < depth_m.rows * depth_m.cols; ++i) {
    const float z = depth_m.ptr<float>()[i];
    const float far = farthest.ptr<float>()[i];
    if (z <= 0 || far <= 0) continue;
    const float near = nearest.ptr<float>()[i];
    const float step = kStepM * std::max(1.0F, z * z);
    const float same = kSameShare * step;
    if (std::uint8_t& appeared = evidence.appeared.data[i];
        z < near - step && before.ptr<float>()[i] != kNothing)
      appeared = static_cast<std::uint8_t>(std::min(255, appeared + 1));
    else if (z > near - same && z < far + same)
      evidence.unchanged.data[i] = 255;
  }
}

}  // namespace

SeenCells::SeenCells(const cv::Mat1f& depth_m, const cv::Mat1b& mask, const GridGeometry& grid,
                     const geometry::Pose& pose)
    : points(depth_m.total(), 3), map_from_camera(pose) {
  Eigen::Index seen = 0;
  for (int r = 0; r < depth_m.rows; ++r)
    for (int c = 0; c < depth_m.cols; ++c)
      if (depth_m(r, c) > 0 && (mask.empty() || mask(r, c) == 0))
        points.row(seen++) = depth_m(r, c) * grid.ray(c, r).array();
  points.conservativeResize(seen, 3);
}

MotionEvidence compare_with_past(const cv::Mat1f& depth_m, const GridGeometry& grid,
                                 const geometry::Pose& camera_from_map, std::span<const SeenCells> past) {
  MotionEvidence evidence{cv::Mat1b(grid.size(), std::uint8_t{0}), cv::Mat1b(grid.size(), std::uint8_t{0})};
  for (const SeenCells& seen : past) judge(depth_m, seen_from_here(seen, grid, camera_from_map), evidence);
  // One earlier picture alone may be wrong: where others saw the place too, they have to agree.
  cv::threshold(evidence.appeared, evidence.appeared,
                std::min<double>(kWitnesses, static_cast<double>(past.size())) - 0.5, 255, cv::THRESH_BINARY);
  cv::morphologyEx(evidence.appeared, evidence.appeared, cv::MORPH_OPEN,
                   cv::Mat::ones(kThinnest, kThinnest, CV_8U));
  evidence.unchanged.setTo(0, evidence.appeared);
  const int appeared = cv::countNonZero(evidence.appeared);
  if (appeared > kMaxShare * (appeared + cv::countNonZero(evidence.unchanged))) return {};
  return evidence;
}

}  // namespace rds::segmentation
