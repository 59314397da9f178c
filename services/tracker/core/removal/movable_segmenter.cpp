// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/removal/movable_segmenter.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "common/dynamic_segmentation/box_evidence.hpp"
#include "common/dynamic_segmentation/colour_model.hpp"
#include "common/dynamic_segmentation/surfaces.hpp"

namespace rds::tracker {
namespace {

using namespace segmentation;

constexpr double kNsPerSecond = 1e9;
constexpr double kReferenceS = 0.25;    // between the earlier pictures that a new one is compared with
constexpr std::size_t kReferences = 2;  // earlier pictures
constexpr int kStableCells = 2;         // around a stable point
constexpr double kStableStepM = 0.03;
constexpr double kSurfaceStepM = 0.05;  // between where a surface was and is

}  // namespace

void MovableSegmenter::set_picture(const image::RgbdFrame& picture) {
  if (picture.camera != grid_.camera()) {
    forget();
    grid_ = GridGeometry(picture.camera, depth_.noise);
  }
  last_ = std::exchange(now_, Now());
  now_.stamp_ns = picture.stamp_ns;
  now_.cells.depth_m = depth_in_cells(picture.depth, grid_, depth_.max_depth_m);
  if (config_.method == "depth")
    now_.cells.colours = colours_in_cells(picture.color, grid_.size(), grid_.cell_px());
}

void MovableSegmenter::detect_motion(const geometry::Pose& camera_from_map) {
  if (config_.method != "depth" || !last_.sure) return;
  now_.camera_from_map = camera_from_map;
  if (config_.motion) now_.motion = compare_with_past(now_.cells.depth_m, grid_, camera_from_map, past_);
}

MovableMask MovableSegmenter::segment(std::span<const ObjectRegion> regions,
                                      std::span<const Eigen::Vector3f> stable) {
  if (config_.method == "off") return {};
  if (config_.method == "box") return whole_boxes(regions);
  mark_stable(stable);
  const bool has_appeared = !now_.motion.appeared.empty() && cv::countNonZero(now_.motion.appeared) > 0;
  if (regions.empty() && !has_appeared && !last_.widened.any()) return {};
  now_.segmentation = segmentation::segment(now_.cells, grid_, {regions, now_.motion, carried()});
  return now_.widened = widened(now_.segmentation.log_odds);
}

/// Marks the surfaces right around points that show where they have always been.
void MovableSegmenter::mark_stable(std::span<const Eigen::Vector3f> stable) {
  const cv::Mat1f& depth_m = now_.cells.depth_m;
  now_.cells.stable = cv::Mat1b(grid_.size(), std::uint8_t{0});
  for (const Eigen::Vector3f& p : stable) {
    const cv::Point middle = grid_.cell_of(p);
    if (middle.x < 0) continue;
    const cv::Rect around = cv::Rect(middle - cv::Point(kStableCells, kStableCells),
                                     middle + cv::Point(kStableCells + 1, kStableCells + 1)) &
                            cv::Rect({0, 0}, grid_.size());
    for (int r = around.y; r < around.br().y; ++r)
      for (int c = around.x; c < around.br().x; ++c)
        if (depth_m(r, c) > 0 && one_surface(depth_m(r, c), p.z(), kStableStepM))
          now_.cells.stable(r, c) = 255;
  }
}

/// What the last picture tells of surfaces that have not moved since: what was movable then still is. What
/// was static may be somebody who stood.
cv::Mat1f MovableSegmenter::carried() const {
  if (!now_.camera_from_map || !last_.map_from_camera || !last_.widened.any()) return {};
  cv::Mat1f told(grid_.size(), std::numeric_limits<float>::lowest());
  const double passed_s = static_cast<double>(now_.stamp_ns - last_.stamp_ns) / kNsPerSecond;
  const Eigen::Isometry3f here_from_last = (*now_.camera_from_map * *last_.map_from_camera).cast<float>();
  for (int r = 0; r < told.rows; ++r)
    for (int c = 0; c < told.cols; ++c) {
      const float z = last_.cells.depth_m(r, c);
      if (!(last_.segmentation.log_odds(r, c) > 0) || !(z > 0)) continue;
      const Eigen::Vector3f p = here_from_last * (z * grid_.ray(c, r));
      const cv::Point cell = grid_.cell_of(p);
      if (cell.x < 0 || !one_surface(now_.cells.depth_m(cell), p.z(), kSurfaceStepM)) continue;
      told(cell) = std::max(told(cell), lasting_presence(last_.segmentation.presence(r, c), passed_s));
    }
  return told;
}

void MovableSegmenter::set_pose(const geometry::Pose& map_from_camera, bool sure) {
  now_.map_from_camera = map_from_camera;
  now_.sure = sure;
  if (!sure || now_.cells.depth_m.empty() || config_.method != "depth") return;
  const auto step_ns = static_cast<std::int64_t>(kReferenceS * kNsPerSecond);
  if (!past_.empty() && now_.stamp_ns - newest_past_ns_ < step_ns) return;
  if (past_.size() == kReferences) past_.erase(past_.begin());
  past_.emplace_back(now_.cells.depth_m, now_.widened.cells(), grid_, map_from_camera);
  newest_past_ns_ = now_.stamp_ns;
}

MovableMask MovableSegmenter::segment_keyframe(const PictureCells& picture,
                                               std::span<const ObjectRegion> regions) const {
  if (config_.method == "off" || picture.depth_m.size() != grid_.size()) return {};
  if (config_.method == "box") return whole_boxes(regions);
  return widened(segmentation::segment(picture, grid_, {regions, {}, {}}).log_odds);
}

MovableMask MovableSegmenter::whole_boxes(std::span<const ObjectRegion> regions) const {
  cv::Mat1b mask(grid_.size(), std::uint8_t{0});
  for (const ObjectRegion& region : regions) mask(cells_of(region.box_px, grid_)).setTo(255);
  return {mask, grid_.cell_px()};
}

/// What is movable, and a rim of one cell, as depth is wrong there.
MovableMask MovableSegmenter::widened(const cv::Mat1f& log_odds) const {
  cv::Mat1b mask(log_odds > 0);
  if (cv::countNonZero(mask) == 0) return {};
  cv::dilate(mask, mask, cv::Mat());
  return {mask, grid_.cell_px()};
}

void MovableSegmenter::forget() {
  past_.clear();
  now_ = Now();
  last_ = Now();
}

}  // namespace rds::tracker
