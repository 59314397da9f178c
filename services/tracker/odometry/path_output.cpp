// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/odometry/path_output.hpp"

#include <algorithm>

#include "common/messages/conversions.hpp"
#include "common/topics/endpoints.hpp"

namespace rds::tracker {
namespace {

constexpr std::chrono::seconds kPeriod{1};

}  // namespace

PathOutput::PathOutput(service::ServiceContext& context)
    : map_frame_(context.frame("map")),
      publisher_(topics::advertise(context.bus, topics::kTrajectory, topics::kTracker)) {}

bool PathOutput::has_new_reader() {
  const int readers = publisher_.matched();
  informed_readers_ = std::min(informed_readers_, readers);
  return readers > informed_readers_;
}

void PathOutput::publish(std::span<const geometry::KeyframePose> poses, bool is_last) {
  const bool is_due = is_last || has_new_reader() || Clock::now() - written_ >= kPeriod;
  informed_readers_ = publisher_.matched();
  if (informed_readers_ == 0 || poses.empty() || !is_due) return;
  written_ = Clock::now();
  nav_msgs::msg::Path path;
  path.header(messages::make_header(poses.back().stamp_ns, map_frame_));
  path.poses().reserve(poses.size());
  for (const geometry::KeyframePose& keyframe : poses) {
    geometry_msgs::msg::PoseStamped& pose = path.poses().emplace_back();
    pose.header(messages::make_header(keyframe.stamp_ns, map_frame_));
    pose.pose(messages::to_pose_message(keyframe.map_from_camera));
  }
  publisher_.write(path);
}

}  // namespace rds::tracker
