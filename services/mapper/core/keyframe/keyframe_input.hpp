// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/box.hpp"
#include "common/geometry/camera_model.hpp"
#include "common/geometry/keyframe_pose.hpp"
#include "common/geometry/pose.hpp"
#include "common/image/rgbd_frame.hpp"

namespace rds::mapper {

/// What detector and transformer say about one object in one keyframe.
///
/// Either `box_px` has an area or `box_in_map` is set; a missing 2-D box is the projection of the 3-D box.
struct LabelledBox {
  std::string label;
  float score = 0;
  geometry::Box2 box_px;                     // [px] of the full picture
  std::optional<geometry::Box3> box_in_map;  // [m], with the keyframe's pose of KeyframeInput
  float depth_m = 0;                         // of the object; 0 = unknown, estimated inside the box
  bool movable = false;
};

/// One keyframe as it arrives. `boxes` is nullopt until a detector has looked at it, and empty if it found
/// nothing: objects fade only in the second case.
struct KeyframeInput {
  std::uint64_t id = 0;
  std::int64_t stamp_ns = 0;
  geometry::Pose map_from_camera = geometry::Pose::Identity();
  image::ColorImage color;
  image::DepthImage depth;
  geometry::CameraModel camera;
  std::optional<std::vector<LabelledBox>> boxes;
  cv::Mat1b movable_cells;  // square cells of the picture: not 0 where something movable shows; empty: none
};

using geometry::KeyframePose;

}  // namespace rds::mapper
