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

/// One keyframe as it arrives. `boxes` is nullopt while nobody has looked for objects in it,
/// and empty when somebody looked and found nothing: objects fade only in the second case.
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

/// What one step changed in the map. Applied to a tree of `base_revision` it gives the tree of `revision`.
/// Row i of each array is voxel i; keys are OctoMap keys at the finest level.
struct MapDelta {
  std::uint64_t map_epoch = 0;
  std::uint64_t map_id = 0;  // of the map within the epoch; who sends the delta sets it
  std::uint64_t base_revision = 0;
  std::uint64_t revision = 0;
  std::uint64_t keyframe_id = 0;
  std::int64_t stamp_ns = 0;
  double resolution = 0;                    // [m]
  std::vector<std::uint16_t> keys;          // 3N: x y z
  std::vector<float> log_odds;              // N, new values
  std::vector<std::uint16_t> labels;        // N, index into the label table; 0 = no object
  std::vector<std::uint8_t> colors;         // 3N: r g b
  std::vector<std::uint16_t> deleted_keys;  // 3M

  /// True when there is nothing to tell: the revision did not change.
  [[nodiscard]] bool is_noop() const { return revision == base_revision; }
};

/// An object as the database knows it, in the map frame.
struct MapObject {
  std::uint64_t id = 0;
  std::string label;
  float score = 0;  // observation-weighted mean of the detector's scores
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  std::uint32_t observations = 0;
  std::int64_t first_seen_ns = 0;
  std::int64_t last_seen_ns = 0;
  bool movable = false;
};

}  // namespace rds::mapper
