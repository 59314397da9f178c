// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/pose.hpp"
#include "services/tracker/core/removal/background.hpp"
#include "services/tracker/core/removal/motion_evidence.hpp"
#include "services/tracker/core/removal/movable_mask.hpp"
#include "services/tracker/core/removal/movable_region.hpp"
#include "services/tracker/core/removal/removal_config.hpp"

namespace rds::tracker {

/// Says from picture to picture which cells show something movable.
///
/// Three sources: the objects in predicted boxes, cut out by depth; what stands where nothing stood before
/// (a mover that no network knows, an arm out of its box); and what was cut from the last picture, carried to
/// this one, for as long as carry_s without support by the others. For one thread at a time.
class MovableSegmenter {
 public:
  MovableSegmenter(const RemovalConfig& config, double max_depth_m)
      : config_(config), max_depth_m_(max_depth_m) {}

  /// First: takes in a picture's depth.
  void look_at(const image::RgbdFrame& picture);
  /// Then, where the picture's pose is known, near to the truth: what has changed since earlier pictures?
  /// Without, and after a picture whose pose was not sure (the guess comes from it), cut() knows of boxes
  /// only.
  void compare(const geometry::Pose& camera_from_map);
  /// @param regions  predicted boxes with their depth intervals.
  /// @param stable  points, in the camera frame, that have stood still for long: what shows them is static.
  MovableMask cut(std::span<const MovableRegion> regions, std::span<const Eigen::Vector3f> stable);
  /// The pose of the picture that was cut last. Later ones are compared with pictures whose pose is sure
  /// only.
  void remember(const geometry::Pose& map_from_camera, bool sure);
  /// What segment_late() needs of the picture that was cut last, when its boxes come.
  [[nodiscard]] const PictureCells& latest() const { return now_.cells; }
  /// Cells of the same picture, not 0 where something movable shows; empty if there is nothing.
  [[nodiscard]] const cv::Mat1b& latest_mask() const { return now_.widened.cells(); }
  [[nodiscard]] const GridGeometry& grid() const { return grid_; }
  /// The objects in late boxes of an earlier picture.
  [[nodiscard]] MovableMask segment_late(const PictureCells& picture,
                                         std::span<const MovableRegion> regions) const;
  /// The map has moved: earlier pictures say nothing any more.
  void forget();

 private:
  using Objects = std::vector<std::vector<cv::Point>>;

  struct Now {
    std::int64_t stamp_ns = 0;
    PictureCells cells;
    std::optional<geometry::Pose> camera_from_map;  // as it was guessed
    Objects moved;
    cv::Mat1b mask;                                 // without rim
    cv::Mat1f unsupported_s;                        // for how long, where the mask is set
    MovableMask widened;                            // with rim; empty where nothing is set
    std::optional<geometry::Pose> map_from_camera;  // that was found in the end
    bool sure = true;                               // is that
  };

  void mark(std::span<const MovableRegion> regions);
  void mark_stable(std::span<const Eigen::Vector3f> stable);
  void carry(const Background& background);
  [[nodiscard]] MovableMask whole_boxes(std::span<const MovableRegion> regions) const;
  [[nodiscard]] MovableMask widened(const cv::Mat1f& depth_m, const cv::Mat1b& mask) const;

  RemovalConfig config_;
  double max_depth_m_;
  GridGeometry grid_;
  Now now_;
  Now last_;
  std::vector<SeenCells> past_;  // by stamp
  std::int64_t newest_past_ns_ = 0;
};

}  // namespace rds::tracker
