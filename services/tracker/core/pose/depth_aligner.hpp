// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/geometry/pose.hpp"
#include "common/dynamic_segmentation/motion_evidence.hpp"

namespace rds::tracker {

/// What an earlier picture showed.
struct EarlierView {
  segmentation::SeenCells fixed;
  segmentation::SeenCells movable;  // may have moved since, and counts little; the same pose
};

/// Where the camera is by depth alone: what an earlier picture saw is laid on the surfaces that this one
/// shows.
///
/// Point to plane, each point with the cell it shows up in (Newcombe et al. 2011, KinectFusion, §3.5), with
/// Tukey's loss: what has moved disagrees.
/// @param depth_m  of the new picture, in the cells of `grid`.
/// @param guess    camera_from_map, to about 0.1 m and 5°.
/// @return camera_from_map; nullopt where too little of what was seen shows again, or its surfaces leave the
/// camera free to move in some direction, as a single wall does.
std::optional<geometry::Pose> align_depth(const EarlierView& before, const cv::Mat1f& depth_m,
                                          const segmentation::GridGeometry& grid,
                                          const geometry::Pose& guess);

/// A depth picture in the cells of a grid. Shared, not copied.
struct DepthView {
  const segmentation::GridGeometry* grid = nullptr;
  cv::Mat1f depth_m;  // 0 where nothing was measured
  cv::Mat1b movable;  // not 0 where something movable shows; empty: nowhere
};

/// Estimates the pose from depth alone, by alignment with the depth of the picture before.
class DepthAligner {
 public:
  /// @return as align_depth(); nullopt, too, where the picture before has no pose.
  [[nodiscard]] std::optional<geometry::Pose> estimate(const DepthView& view,
                                                       const geometry::Pose& guess) const;
  /// The picture before the next one, and its pose.
  void set_previous(const DepthView& view, const geometry::Pose& map_from_camera);
  /// The picture before the next one has no pose, or the map has moved since.
  void forget() { previous_.reset(); }

 private:
  struct Previous {
    cv::Mat1f depth_m;
    cv::Mat1b movable;
    geometry::CameraModel camera;
    geometry::Pose map_from_camera;
  };

  std::optional<Previous> previous_;
};

}  // namespace rds::tracker
