// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/dynamic_segmentation/dynamic_segmentation.hpp"
#include "common/geometry/pose.hpp"
#include "services/tracker/core/config/tracker_config.hpp"
#include "services/tracker/core/removal/movable_mask.hpp"

namespace rds::tracker {

/// Segments each picture into cells that show something movable, and others.
///
/// It keeps what the evidence needs of earlier pictures: their depth, and what was movable in the last one.
/// The decision is segmentation::segment()'s. For one thread at a time.
class MovableSegmenter {
 public:
  using GridGeometry = segmentation::GridGeometry;
  using ObjectRegion = segmentation::ObjectRegion;
  using PictureCells = segmentation::PictureCells;

  MovableSegmenter(const RemovalConfig& config, const DepthConfig& depth) : config_(config), depth_(depth) {}

  /// First: the next picture; its depth is used.
  void set_picture(const image::RgbdFrame& picture);
  /// Then, where the picture's pose is known to a few centimetres: compares it with earlier pictures.
  /// Without, and after a picture whose pose was not sure (the guess rests on it), segment() uses boxes only.
  void detect_motion(const geometry::Pose& camera_from_map);
  /// @param regions  predicted boxes with their depth intervals.
  /// @param stable   stable map points in the camera frame: surfaces that show them are static.
  MovableMask segment(std::span<const ObjectRegion> regions, std::span<const Eigen::Vector3f> stable);
  /// Last: the picture's pose. Later pictures are compared only with those whose pose is sure.
  void set_pose(const geometry::Pose& map_from_camera, bool sure);
  /// The picture in cells, as segment_keyframe() needs it when late boxes come.
  [[nodiscard]] const PictureCells& latest() const { return now_.cells; }
  /// Cells of the picture, not 0 where something movable shows; empty if there is nothing.
  [[nodiscard]] const cv::Mat1b& latest_mask() const { return now_.widened.cells(); }
  [[nodiscard]] const GridGeometry& grid() const { return grid_; }
  /// Movable cells of an earlier picture, by its late boxes.
  [[nodiscard]] MovableMask segment_keyframe(const PictureCells& picture,
                                             std::span<const ObjectRegion> regions) const;
  /// The map has moved: earlier pictures say nothing any more.
  void forget();

 private:
  struct Now {
    std::int64_t stamp_ns = 0;
    PictureCells cells;
    std::optional<geometry::Pose> camera_from_map;  // as it was guessed
    segmentation::MotionEvidence motion;            // what detect_motion() found
    segmentation::Segmentation segmentation;        // empty if there is no evidence
    MovableMask widened;                            // with rim; empty where nothing is set
    std::optional<geometry::Pose> map_from_camera;  // that was found in the end
    bool sure = true;                               // is that
  };

  void mark_stable(std::span<const Eigen::Vector3f> stable);
  [[nodiscard]] cv::Mat1f carried() const;
  [[nodiscard]] MovableMask whole_boxes(std::span<const ObjectRegion> regions) const;
  [[nodiscard]] MovableMask widened(const cv::Mat1f& log_odds) const;

  RemovalConfig config_;
  DepthConfig depth_;
  GridGeometry grid_;
  Now now_;
  Now last_;
  std::vector<segmentation::SeenCells> past_;  // by stamp
  std::int64_t newest_past_ns_ = 0;
};

}  // namespace rds::tracker
