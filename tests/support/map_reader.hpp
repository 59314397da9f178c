// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "common/bus/participant.hpp"
#include "octomap_msgs/msg/Octomap.h"
#include "rds_msgs/msg/MapInfo.h"
#include "rds_msgs/msg/OctreeDelta.h"
#include "services/mapper/core/octree/octree_replica.hpp"

namespace rds::test {

/// What a program of somebody else would do with rds/map/full, rds/map/info and rds/map/delta: it keeps a
/// copy of the map. A gap in the deltas is closed by the next full map. Safe to use from any thread.
class MapReader {
 public:
  explicit MapReader(bus::Participant& bus);

  /// The copy as mapper::to_bytes() gives it; empty without one.
  std::vector<std::uint8_t> bytes();
  std::uint64_t revision();
  std::uint64_t map_id();
  /// Labelled voxels.
  std::size_t labelled();
  int full_maps();
  int deltas();

 private:
  void on_full(std::shared_ptr<const octomap_msgs::msg::Octomap> message);
  void on_info(std::shared_ptr<const rds_msgs::msg::MapInfo> message);
  void on_delta(const rds_msgs::msg::OctreeDelta& message);
  void take_full();
  void apply_waiting();

  std::mutex mutex_;
  mapper::OctreeReplica replica_;
  std::shared_ptr<const octomap_msgs::msg::Octomap> full_;
  std::map<std::int64_t, std::shared_ptr<const rds_msgs::msg::MapInfo>> infos_;
  std::map<std::pair<std::uint64_t, std::uint64_t>, mapper::MapDelta> waiting_;  // by map id, base revision
  int full_maps_ = 0;
  int deltas_ = 0;
  std::vector<bus::Subscription> subscriptions_;  // last: callbacks use the members above
};

}  // namespace rds::test
