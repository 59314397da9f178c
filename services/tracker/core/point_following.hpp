// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/image/rgbd_frame.hpp"
#include "services/tracker/core/association.hpp"
#include "services/tracker/core/image_pyramid.hpp"
#include "services/tracker/core/removal/movable_mask.hpp"
#include "services/tracker/core/run_parts.hpp"

namespace rds::tracker {

/// A picture in which map points are followed.
struct FollowingView {
  const image::RgbdFrame& picture;
  const ImagePyramid& images;               // of the picture
  const MovableMask& movable;               // where static points are hidden
  Pose camera_from_map = Pose::Identity();  // near to the truth: features are a few pixels off at most
  ShutterMotion motion;
};

/// Map points found in a picture without extracting features.
struct FollowedPoints {
  std::vector<Feature> features;  // image_px; level, angle and descriptor as in the map. Not matchable.
  std::vector<PointId> points;    // per feature; kNoId: not looked for, because something movable is there
  std::vector<PointId> looked_for;
};

/// Finds map points in a picture by the patch around the feature of the keyframe that saw them from nearest.
///
/// The most observed points of every part of the picture come first, until config.points are found. A point
/// whose patch looks otherwise there is hidden or gone and is left out.
FollowedPoints follow_points(const SlamMap& map, std::span<const PointId> points, const FollowingView& view,
                             const ObservationModel& model, const ScalePyramid& pyramid,
                             const FollowingConfig& config, const RunParts& run_parts = run_in_turn);

}  // namespace rds::tracker
