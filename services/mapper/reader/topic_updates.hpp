// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "common/service/service.hpp"
#include "octomap_msgs/msg/Octomap.h"
#include "rds_msgs/msg/MapInfo.h"
#include "rds_msgs/msg/OctreeDelta.h"
#include "services/mapper/reader/live_replica.hpp"

namespace rds::mapper {

/// Keeps a replica up to date from rds/map/full, rds/map/info and rds/map/delta. Deltas that come before what
/// they build on wait for it; a gap is closed by the next full map.
class TopicUpdates {
 public:
  /// @param context  its diagnostics count what is malformed. @param replica  outlives this.
  TopicUpdates(service::ServiceContext& context, LiveReplica& replica);

 private:
  using Full = std::shared_ptr<const octomap_msgs::msg::Octomap>;
  using Info = std::shared_ptr<const rds_msgs::msg::MapInfo>;

  void take(Full full);
  void take(Info info);
  void take(const rds_msgs::msg::OctreeDelta& delta);
  void apply_full();
  void apply_waiting();
  void note(const char* topic, const ReplicaAnswer& answer);

  service::ServiceContext& context_;
  LiveReplica& replica_;
  std::mutex mutex_;
  Full full_;  // that has not been applied
  std::map<std::int64_t, Info> infos_;                                   // of full maps, by stamp
  std::map<std::pair<std::uint64_t, std::uint64_t>, MapDelta> waiting_;  // by map id, base revision
  std::vector<bus::Subscription> subscriptions_;  // last: callbacks use the members above
};

}  // namespace rds::mapper
