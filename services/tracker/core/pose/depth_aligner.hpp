// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/geometry/pose.hpp"
#include "services/tracker/core/removal/depth_grid.hpp"

namespace rds::tracker {

/// A depth picture in the cells of a grid. Shared, not copied.
struct DepthView {
  const GridGeometry* grid = nullptr;
  cv::Mat1f depth_m;  // 0 where nothing was measured
  cv::Mat1b movable;  // not 0 where something movable shows; empty: nowhere
};

/// Estimates the pose from depth alone, by alignment with the depth of the picture before
/// (depth_alignment.hpp).
class DepthAligner {
 public:
  /// @param guess  camera_from_map, to about 0.1 m and 5°.
  /// @return camera_from_map; nullopt where the picture before has no pose or depth does not determine one.
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
