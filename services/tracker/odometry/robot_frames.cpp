// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/odometry/robot_frames.hpp"

namespace rds::tracker {
namespace {

/// The child of `above` on the way from `frame` to the root.
std::string child_below(const TransformTree& tree, const std::string& above, const std::string& frame,
                        std::int64_t stamp_ns) {
  std::string child = frame;
  for (auto parent = tree.parent_of(child, stamp_ns); parent && *parent != above;
       parent = tree.parent_of(child, stamp_ns))
    child = *parent;
  return child;
}

}  // namespace

RobotFrames robot_frames(const TransformTree& tree, const FrameNames& names, const std::string& camera,
                         std::int64_t stamp_ns) {
  RobotFrames frames;
  const std::string root = tree.root_of(camera, stamp_ns);
  frames.odom_from_camera = tree.lookup(names.odom, camera, stamp_ns);
  const bool is_in_anothers_map = root == names.map && !frames.odom_from_camera;
  frames.map_to_odom_is_ours = !is_in_anothers_map && tree.root_of(names.odom, stamp_ns) != names.map;
  frames.odom_to_body_is_ours = !is_in_anothers_map && !frames.odom_from_camera;
  frames.body = frames.odom_from_camera ? child_below(tree, names.odom, camera, stamp_ns) : root;
  frames.body_from_camera = tree.lookup(frames.body, camera, stamp_ns).value_or(geometry::Pose::Identity());
  const auto base_from_camera = tree.lookup(names.base, camera, stamp_ns);
  frames.child = base_from_camera ? names.base : frames.body;
  frames.child_from_camera = base_from_camera.value_or(frames.body_from_camera);
  return frames;
}

}  // namespace rds::tracker
