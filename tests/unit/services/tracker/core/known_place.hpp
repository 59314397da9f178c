// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/mapping/map_building.hpp"
#include "services/tracker/core/pose/tracking_context.hpp"
#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker::test {

/// A map of random points with keyframes from given poses, and frames that see the same points.
class KnownPlace {
 public:
  /// A frame from there whose matches and pose are the true ones.
  TrackedFrame frame_at(const Pose& map_from_camera, std::int64_t time_ns = 0) {
    view = view_of(points, map_from_camera, 0, random);
    TrackedFrame frame;
    frame.stamp_ns = frame.time_ns = time_ns;
    frame.features = view.features;
    for (const std::size_t p : view.point) frame.points.push_back(ids[p]);
    frame.camera_from_map = map_from_camera.inverse();
    return frame;
  }

  /// Makes the frame from there a keyframe. @return its id.
  KeyframeId add_keyframe(const Pose& map_from_camera, std::int64_t time_ns = 0) {
    TrackedFrame frame = frame_at(map_from_camera, time_ns);
    const Keyframe& keyframe = insert_keyframe(map, frame, settings.depth);
    for (std::size_t f = 0; f < view.point.size(); ++f) ids[view.point[f]] = keyframe.points[f];
    return keyframe.id;
  }

  TrackingContext context() {
    return {map, settings, picture, ObservationModel(picture.camera), {}, {}};
  }

  std::mt19937 random{3};
  std::vector<Eigen::Vector3d> points = random_points(600, random);
  SyntheticView view;  // of the last frame
  std::vector<PointId> ids = std::vector<PointId>(600, kNoId);
  PoseSettings settings{ScalePyramid(8, 1.2), {}};
  SlamMap map{settings.pyramid};
  image::RgbdFrame picture = dark_picture(0);
};

}  // namespace rds::tracker::test
