// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/record/topic_subscriptions.hpp"

#include <algorithm>
#include <chrono>

#include "common/concurrency/priority.hpp"
#include "common/messages/registry.hpp"
#include "tools/recording/bag/qos_profiles.hpp"
#include "tools/recording/conversion.hpp"

namespace rds::record {
namespace {

constexpr int kHistory = 1000;  // messages; for the moments in which a topic's thread is not served

std::int64_t now_ns() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(since_1970).count();
}

bus::Qos wanted_qos(const std::vector<bus::DiscoveredEndpoint>& publishers) {
  return {.reliable = std::ranges::all_of(publishers, &bus::DiscoveredEndpoint::reliable),
          .transient_local = std::ranges::all_of(publishers, &bus::DiscoveredEndpoint::transient_local),
          .depth = kHistory};
}

std::string offered_profiles(const std::vector<bus::DiscoveredEndpoint>& publishers) {
  std::string profiles;
  for (const auto& publisher : publishers)
    profiles += (profiles.empty() ? "" : "\n") +
                recording::offered_qos_profile(publisher.reliable, publisher.transient_local);
  return profiles;
}

}  // namespace

TopicSubscriptions::TopicSubscriptions(const bus::ParticipantOptions& options, const TopicChoice& choice,
                                       BagThread& bag)
    : bag_(bag),
      bus_(concurrency::giving_way(kNice, [&] { return bus::Participant::create(options); })),
      choice_(choice.by_full_names([this](const std::string& topic) { return bus_->full_name(topic); })) {}

void TopicSubscriptions::look() {
  std::map<std::string, Publishers> publishers;
  for (const auto& endpoint : bus_->discovered())
    if (endpoint.publisher && choice_.contains(endpoint.topic))
      publishers[endpoint.topic].push_back(endpoint);
  for (const auto& [topic, offered] : publishers) {
    const auto known = topics_.find(topic);
    const bus::Qos qos = wanted_qos(offered);
    const bool fits = known != topics_.end() && known->second.qos.reliable <= qos.reliable &&
                      known->second.qos.transient_local <= qos.transient_local;
    if (!fits) subscribe(topic, offered);
  }
}

/// The type as bytes; nullptr if no IDL file defines it.
const bus::TypeOps* TopicSubscriptions::serialized_type(const std::string& dds_name) {
  const auto* type = messages::find_message_type(dds_name);
  if (type == nullptr) return nullptr;
  return &types_.try_emplace(dds_name, messages::serialized(*type->ops)).first->second;
}

void TopicSubscriptions::subscribe(const std::string& topic, const Publishers& publishers) {
  const bus::TypeOps* type = serialized_type(publishers.front().type);
  if (type == nullptr) {
    unknown_.insert(topic);
    return;
  }
  const auto [entry, is_new] = topics_.try_emplace(topic);
  Subscribed& subscribed = entry->second;
  if (is_new)
    subscribed.number = bag_.add_topic(recording::topic_of("/" + topic, *type, offered_profiles(publishers)));
  subscribed.qos = wanted_qos(publishers);
  subscribed.subscription.reset();
  const auto take = [this, number = subscribed.number](std::shared_ptr<const void> message,
                                                       const bus::ParticipantId&) {
    bag_.push(
        {number, now_ns(), std::static_pointer_cast<const messages::SerializedMessage>(std::move(message))});
  };
  subscribed.subscription = concurrency::giving_way(
      kNice, [&] { return bus_->make_subscription("/" + topic, *type, subscribed.qos, take); });
}

std::uint64_t TopicSubscriptions::lost() const {
  std::uint64_t lost = 0;
  for (const auto& endpoint : bus_->statistics())
    if (!endpoint.publisher) lost += endpoint.dropped;
  return lost;
}

}  // namespace rds::record
