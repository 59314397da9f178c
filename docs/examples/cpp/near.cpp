// SPDX-License-Identifier: Apache-2.0
// Prints what is within 2 m of the robot, each time the map has changed. ROS_DOMAIN_ID says which domain;
// --loopback: this machine only, as rds run is.
#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/messages/conversions.hpp"
#include "rds_msgs/msg/TrackingState.h"
#include "services/mapper/core/octree/voxel_walk.hpp"
#include "services/mapper/reader/map_follower.hpp"

namespace {

using rds_msgs::msg::TrackingState;

constexpr double kRadiusM = 2;

/// What the threads of the bus tell the one that prints.
struct Newest {
  std::mutex mutex;
  std::condition_variable changed;
  bool map_changed = false;
  std::optional<rds::geometry::Pose> map_from_camera;  // none while the camera is lost

  void take_state(const TrackingState& state) {
    const bool lost = state.state() == 0 || state.state() == 3;  // NOT_INITIALIZED, LOST
    const auto pose = rds::messages::to_pose(state.map_from_camera());
    const std::lock_guard lock(mutex);
    map_from_camera = lost || !pose ? std::nullopt : std::optional(*pose);
  }
  void note_map() {
    const std::lock_guard lock(mutex);
    map_changed = true;
    changed.notify_one();
  }
  /// Waits for another map. @return where the robot is [m]; none while it is lost.
  std::optional<Eigen::Vector3d> wait() {
    std::unique_lock lock(mutex);
    changed.wait(lock, [this] { return map_changed; });
    map_changed = false;
    if (!map_from_camera) return std::nullopt;
    return map_from_camera->translation();
  }
};

void report(const rds::mapper::OctreeReplica& map, const std::vector<std::string>& labels,
            const Eigen::Vector3d& position) {
  std::size_t voxels = 0;
  std::map<std::string, double> nearest;  // distance [m], by label
  rds::mapper::for_each_voxel(map.tree(), [&](const octomap::OcTreeKey& key, const auto& voxel) {
    if (!map.tree().isNodeOccupied(voxel)) return;
    const auto center = map.tree().keyToCoord(key);
    const double distance = (Eigen::Vector3d(center.x(), center.y(), center.z()) - position).norm();
    if (distance >= kRadiusM) return;
    ++voxels;
    const auto label = map.label(key);
    if (label == 0 || label >= labels.size()) return;
    double& least = nearest.try_emplace(labels[label], distance).first->second;
    least = std::min(least, distance);
  });
  std::cout << "revision " << map.revision() << ": " << voxels << " voxels within " << kRadiusM << " m";
  for (const auto& [label, distance] : nearest) std::cout << ", " << label << " at " << distance << " m";
  std::cout << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  const char* domain = std::getenv("ROS_DOMAIN_ID");
  const auto bus =
      rds::bus::Participant::create({.domain = domain != nullptr ? std::atoi(domain) : 0,
                                     .node_name = "near",
                                     .loopback_only = argc > 1 && std::string_view(argv[1]) == "--loopback"});
  Newest newest;
  rds::service::Diagnostics diagnostics;
  rds::service::ServiceContext context{"near", *bus, diagnostics};
  const rds::mapper::MapFollower follower(context, rds::transfer::this_host(),
                                          [&](const rds::mapper::MapDelta*) { newest.note_map(); });
  const auto states = bus->subscribe<TrackingState>("rds/tracking_state", rds::bus::kStream,
                                                    [&](const auto& state) { newest.take_state(*state); });
  for (;;)
    if (const auto position = newest.wait())
      follower.map().look([&](const auto& map, const auto& labels) { report(map, labels, *position); });
}
