// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "common/concurrency/mailbox.hpp"
#include "common/service/service.hpp"
#include "octomap_msgs/msg/Octomap.h"
#include "rds_msgs/msg/MapInfo.h"
#include "rds_msgs/msg/OctreeDelta.h"
#include "services/mapper/reader/live_replica.hpp"

namespace rds::mapper {

/// Keeps a replica up to date from rds/map/full, rds/map/info and rds/map/delta, on a thread of its own.
/// Deltas that come before what they build on wait for it; a gap is closed by the next full map.
class TopicUpdates {
 public:
  /// @param context  its diagnostics count what is malformed. @param replica  outlives this.
  TopicUpdates(service::ServiceContext& context, LiveReplica& replica);

 private:
  using Full = std::shared_ptr<const octomap_msgs::msg::Octomap>;
  using Info = std::shared_ptr<const rds_msgs::msg::MapInfo>;
  using Delta = std::shared_ptr<const rds_msgs::msg::OctreeDelta>;

  void run(const std::stop_token& stop);
  void take(Full full);
  void take(Info info);
  void take(const Delta& delta);
  void apply_full();
  void apply_waiting();
  void note(const char* topic, const ReplicaAnswer& answer);

  service::ServiceContext& context_;
  LiveReplica& replica_;
  Full full_;                                                            // that has not been applied
  std::map<std::int64_t, Info> infos_;                                   // of full maps, by stamp
  std::map<std::pair<std::uint64_t, std::uint64_t>, MapDelta> waiting_;  // by map id, base revision
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<Full> fulls_come_;
  concurrency::Inbox<Info> infos_come_;
  concurrency::Inbox<Delta> deltas_come_;
  std::vector<bus::Subscription> subscriptions_;
  std::jthread thread_;  // last: it uses the members above
};

}  // namespace rds::mapper
