// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/pose.hpp"
#include "services/tracker/core/config/tracker_config.hpp"
#include "services/tracker/core/removal/background.hpp"
#include "services/tracker/core/removal/motion_evidence.hpp"
#include "services/tracker/core/removal/movable_mask.hpp"
#include "services/tracker/core/removal/movable_region.hpp"

namespace rds::tracker {

/// Segments each picture into cells that show something movable, and others.
///
/// Movable are: the surfaces in predicted boxes, chosen by depth; what stands where nothing stood before (an
/// object that no network knows, an arm outside its box); and what was movable in the last picture and has
/// not moved since, for half a second without either. For one thread at a time.
class MovableSegmenter {
 public:
  MovableSegmenter(const RemovalConfig& config, const DepthConfig& depth) : config_(config), depth_(depth) {}

  /// First: the next picture; its depth is used.
  void set_picture(const image::RgbdFrame& picture);
  /// Then, where the picture's pose is known to a few centimetres: compares it with earlier pictures.
  /// Without, and after a picture whose pose was not sure (the guess rests on it), segment() uses boxes only.
  void detect_motion(const geometry::Pose& camera_from_map);
  /// @param regions  predicted boxes with their depth intervals.
  /// @param stable   stable map points in the camera frame: surfaces that show them are static.
  MovableMask segment(std::span<const MovableRegion> regions, std::span<const Eigen::Vector3f> stable);
  /// Last: the picture's pose. Later pictures are compared only with those whose pose is sure.
  void set_pose(const geometry::Pose& map_from_camera, bool sure);
  /// The picture in cells, as segment_keyframe() needs it when late boxes come.
  [[nodiscard]] const PictureCells& latest() const { return now_.cells; }
  /// Cells of the picture, not 0 where something movable shows; empty if there is nothing.
  [[nodiscard]] const cv::Mat1b& latest_mask() const { return now_.widened.cells(); }
  [[nodiscard]] const GridGeometry& grid() const { return grid_; }
  /// Movable cells of an earlier picture, by its late boxes.
  [[nodiscard]] MovableMask segment_keyframe(const PictureCells& picture,
                                             std::span<const MovableRegion> regions) const;
  /// The map has moved: earlier pictures say nothing any more.
  void forget();

 private:
  using Objects = std::vector<std::vector<cv::Point>>;

  struct Now {
    std::int64_t stamp_ns = 0;
    PictureCells cells;
    std::optional<geometry::Pose> camera_from_map;  // as it was guessed
    Objects moved;                                  // what detect_motion() found
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
  DepthConfig depth_;
  GridGeometry grid_;
  Now now_;
  Now last_;
  std::vector<SeenCells> past_;  // by stamp
  std::int64_t newest_past_ns_ = 0;
};

}  // namespace rds::tracker
