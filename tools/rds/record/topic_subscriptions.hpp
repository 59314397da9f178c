// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "common/bus/participant.hpp"
#include "tools/rds/record/bag_thread.hpp"
#include "tools/rds/record/topic_choice.hpp"

namespace rds::record {

/// Subscribes to chosen topics as their publishers come up, and hands their messages on as they are on the
/// wire.
class TopicSubscriptions {
 public:
  TopicSubscriptions(const bus::ParticipantOptions& options, const TopicChoice& choice, BagThread& bag);

  /// Subscribes to what has come up since, with the strongest QoS that all publishers of a topic offer;
  /// again, where a publisher came that offers less.
  void look();
  /// Names of chosen topics whose type no IDL file defines; they are not recorded.
  [[nodiscard]] const std::set<std::string>& unknown() const { return unknown_; }
  /// Messages that the bus has lost, as far as it knows.
  [[nodiscard]] std::uint64_t lost() const;

 private:
  struct Subscribed {
    std::size_t number = 0;  // in the bag
    bus::Qos qos;
    std::unique_ptr<bus::detail::SubscriptionEndpoint> subscription;
  };
  using Publishers = std::vector<bus::DiscoveredEndpoint>;
  void subscribe(const std::string& topic, const Publishers& publishers);
  const bus::TypeOps* serialized_type(const std::string& dds_name);

  BagThread& bag_;
  std::map<std::string, bus::TypeOps> types_;  // by DDS name; before the participant, which uses them
  std::unique_ptr<bus::Participant> bus_;
  TopicChoice choice_;  // full names
  std::map<std::string, Subscribed> topics_;
  std::set<std::string> unknown_;
};

}  // namespace rds::record
