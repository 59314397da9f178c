// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/odometry/robot_frames.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

namespace rds::tracker {
namespace {

/// Of an ancestry: the child of `above`, or the root if `above` is not in it.
std::string child_below(const std::string& above, const std::vector<std::string>& ancestry) {
  const auto found = std::ranges::find(ancestry, above);
  return found == ancestry.begin() ? above : *std::prev(found);
}

}  // namespace

RobotFrames robot_frames(const geometry::TransformTree& tree, const FrameNames& names,
                         const std::string& camera, std::int64_t stamp_ns) {
  RobotFrames frames;
  const auto above_camera = tree.ancestry(camera, stamp_ns);
  const std::string& root = above_camera.back();
  frames.odom_from_camera = tree.lookup(names.odom, camera, stamp_ns);
  const bool is_in_anothers_map = root == names.map && !frames.odom_from_camera;
  frames.map_to_odom_is_ours = !is_in_anothers_map && tree.root_of(names.odom, stamp_ns) != names.map;
  frames.odom_to_body_is_ours = !is_in_anothers_map && !frames.odom_from_camera;
  frames.body = frames.odom_from_camera ? child_below(names.odom, above_camera) : root;
  frames.body_from_camera = tree.lookup(frames.body, camera, stamp_ns).value_or(geometry::Pose::Identity());
  const auto base_from_camera = tree.lookup(names.base, camera, stamp_ns);
  frames.child = base_from_camera ? names.base : frames.body;
  frames.child_from_camera = base_from_camera.value_or(frames.body_from_camera);
  return frames;
}

}  // namespace rds::tracker
