// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/removal/movable_segmenter.hpp"

#include <algorithm>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "services/tracker/core/removal/box_cut.hpp"
#include "services/tracker/core/removal/surfaces.hpp"

namespace rds::tracker {
namespace {

constexpr double kNsPerSecond = 1e9;
constexpr float kCarryS = 0.5F;         // how long a part stays cut that neither box nor motion supports
constexpr double kReferenceS = 0.25;    // between the earlier pictures that a new one is compared with
constexpr std::size_t kReferences = 2;  // earlier pictures
constexpr int kStableCells = 2;         // around a stable point
constexpr double kStableStepM = 0.03;

}  // namespace

void MovableSegmenter::set_picture(const image::RgbdFrame& picture) {
  if (picture.camera != grid_.camera()) {
    forget();
    grid_ = GridGeometry(picture.camera, depth_.noise);
  }
  last_ = std::exchange(now_, Now());
  now_.stamp_ns = picture.stamp_ns;
  now_.cells.depth_m = depth_in_cells(picture.depth, grid_, depth_.max_depth_m);
}

void MovableSegmenter::detect_motion(const geometry::Pose& camera_from_map) {
  if (config_.method != "depth" || !last_.sure) return;
  now_.camera_from_map = camera_from_map;
  if (!config_.motion) return;
  const cv::Mat1f& depth_m = now_.cells.depth_m;
  now_.moved = moving_objects(depth_m, compare_with_past(depth_m, grid_, camera_from_map, past_));
}

MovableMask MovableSegmenter::segment(std::span<const MovableRegion> regions,
                                      std::span<const Eigen::Vector3f> stable) {
  if (config_.method == "off") return {};
  if (config_.method == "box") return whole_boxes(regions);
  now_.mask = cv::Mat1b(grid_.size(), std::uint8_t{0});
  now_.unsupported_s = cv::Mat1f(grid_.size(), 0.0F);
  mark_stable(stable);
  if (!regions.empty() || !now_.moved.empty() || last_.widened.any()) mark(regions);
  if (cv::countNonZero(now_.mask) > 0) now_.widened = widened(now_.cells.depth_m, now_.mask);
  return now_.widened;
}

void MovableSegmenter::mark(std::span<const MovableRegion> regions) {
  cv::Mat1b unknown(grid_.size(), std::uint8_t{0});
  fill_boxes(grid_, regions, unknown);
  for (const auto& cells : now_.moved) unknown(cv::boundingRect(cells)).setTo(255);
  const Background background(now_.cells, grid_, unknown);
  Foreground foreground(now_.cells, background);
  mark_boxes(foreground, grid_, regions, now_.mask);
  for (const auto& cells : now_.moved) mark_moved(foreground, grid_, cells, now_.mask);
  if (now_.camera_from_map && last_.map_from_camera && last_.widened.any()) carry(background);
}

/// Marks the surfaces right around points that show where they have always been.
void MovableSegmenter::mark_stable(std::span<const Eigen::Vector3f> stable) {
  const cv::Mat1f& depth_m = now_.cells.depth_m;
  now_.cells.stable = cv::Mat1b(grid_.size(), std::uint8_t{0});
  const cv::Rect inside({0, 0}, grid_.size());
  for (const Eigen::Vector3f& p : stable) {
    const cv::Point middle = grid_.cell_of(p);
    if (middle.x < 0) continue;
    for (int dy = -kStableCells; dy <= kStableCells; ++dy)
      for (int dx = -kStableCells; dx <= kStableCells; ++dx) {
        const cv::Point cell = middle + cv::Point(dx, dy);
        if (!inside.contains(cell) || !(depth_m(cell) > 0)) continue;
        if (one_surface(depth_m(cell), p.z(), kStableStepM)) now_.cells.stable(cell) = 255;
      }
  }
}

/// Where the parts that were cut from the last picture show now, if they have not moved.
void MovableSegmenter::carry(const Background& background) {
  const auto passed_s =
      static_cast<float>(static_cast<double>(now_.stamp_ns - last_.stamp_ns) / kNsPerSecond);
  const Eigen::Isometry3f here_from_last = (*now_.camera_from_map * *last_.map_from_camera).cast<float>();
  for (int r = 0; r < last_.mask.rows; ++r)
    for (int c = 0; c < last_.mask.cols; ++c) {
      if (last_.mask(r, c) == 0) continue;
      const float age_s = last_.unsupported_s(r, c) + passed_s;
      const float z = last_.cells.depth_m(r, c);
      if (!(z > 0) || age_s > kCarryS) continue;
      const Eigen::Vector3f p = here_from_last * (z * grid_.ray(c, r));
      const cv::Point cell = grid_.cell_of(p);
      if (cell.x < 0 || (now_.mask(cell) != 0 && now_.unsupported_s(cell) == 0)) continue;
      const float here = now_.cells.depth_m(cell);
      if (!(here > 0) || !one_surface(here, p.z(), kSurfaceStepM) || background.shows_wide(cell)) continue;
      float& unsupported = now_.unsupported_s(cell);
      unsupported = now_.mask(cell) == 0 ? age_s : std::min(unsupported, age_s);
      now_.mask(cell) = 255;
    }
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
                                               std::span<const MovableRegion> regions) const {
  if (config_.method == "off" || picture.depth_m.size() != grid_.size()) return {};
  if (config_.method == "box") return whole_boxes(regions);
  cv::Mat1b unknown(grid_.size(), std::uint8_t{0});
  fill_boxes(grid_, regions, unknown);
  const Background background(picture, grid_, unknown);
  Foreground foreground(picture, background);
  cv::Mat1b mask(grid_.size(), std::uint8_t{0});
  mark_boxes(foreground, grid_, regions, mask);
  return widened(picture.depth_m, mask);
}

MovableMask MovableSegmenter::whole_boxes(std::span<const MovableRegion> regions) const {
  cv::Mat1b mask(grid_.size(), std::uint8_t{0});
  fill_boxes(grid_, regions, mask);
  return {mask, grid_.cell_px()};
}

MovableMask MovableSegmenter::widened(const cv::Mat1f& depth_m, const cv::Mat1b& mask) const {
  cv::Mat1b wide = mask.clone();
  close_and_widen(depth_m, wide);
  return {wide, grid_.cell_px()};
}

void MovableSegmenter::forget() {
  past_.clear();
  now_ = Now();
  last_ = Now();
}

}  // namespace rds::tracker
