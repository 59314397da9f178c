// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/reader/topic_updates.hpp"

#include "common/messages/conversions.hpp"
#include "common/topics/endpoints.hpp"

namespace rds::mapper {
namespace {

constexpr std::size_t kNodeBytes = 8;
constexpr std::size_t kMostWaiting = 256;  // deltas; and descriptions of full maps

MapDelta to_delta(const rds_msgs::msg::OctreeDelta& message) {
  MapDelta delta;
  delta.map_epoch = message.map_epoch();
  delta.map_id = message.map_id();
  delta.base_revision = message.base_revision();
  delta.revision = message.revision();
  delta.keyframe_id = message.keyframe_id();
  delta.resolution = message.resolution();
  delta.keys = message.keys();
  delta.log_odds = message.log_odds();
  delta.labels = message.labels();
  delta.colors = message.colors();
  delta.deleted_keys = message.deleted_keys();
  return delta;
}

template <class Map>
void bound(Map& map) {
  while (map.size() > kMostWaiting) map.erase(map.begin());
}

}  // namespace

TopicUpdates::TopicUpdates(service::ServiceContext& context, LiveReplica& replica)
    : context_(context),
      replica_(replica),
      fulls_come_(mailbox_, 1),
      infos_come_(mailbox_, kMostWaiting),
      deltas_come_(mailbox_, kMostWaiting) {
  const auto read = [&](const auto& topic, auto& inbox) {
    subscriptions_.push_back(topics::subscribe(context.bus, topic, topics::kTool,
                                               [&inbox](auto message) { inbox.push(std::move(message)); }));
  };
  read(topics::kMapFull, fulls_come_);
  read(topics::kMapInfo, infos_come_);
  read(topics::kMapDelta, deltas_come_);
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void TopicUpdates::run(const std::stop_token& stop) {
  const auto has_come = [this] {
    return !fulls_come_.locked_empty() || !infos_come_.locked_empty() || !deltas_come_.locked_empty();
  };
  while (mailbox_.wait(stop, has_come)) {
    if (auto full = fulls_come_.try_pop()) take(std::move(*full));
    while (auto info = infos_come_.try_pop()) take(std::move(*info));
    while (const auto delta = deltas_come_.try_pop()) take(*delta);
  }
}

void TopicUpdates::take(Full full) {
  full_ = std::move(full);
  apply_full();
}

/// Another mapper may give the stamp of an earlier one's map again: what is told of that one is over.
void TopicUpdates::take(Info info) {
  std::erase_if(infos_, [&](const auto& told) { return told.second->map_id() != info->map_id(); });
  replica_.tell_labels(info->map_id(), info->labels());
  if (!info->describes_full()) return;
  infos_[messages::to_nanoseconds(info->header().stamp())] = std::move(info);
  bound(infos_);
  apply_full();
}

void TopicUpdates::take(const Delta& message) {
  MapDelta delta = to_delta(*message);
  if (delta.base_revision == 0) {  // the first of a map needs nothing before it
    note(topics::kMapDelta.name, replica_.apply(delta));
  } else {
    waiting_[{delta.map_id, delta.base_revision}] = std::move(delta);
    bound(waiting_);
  }
  apply_waiting();
}

/// The full map and the MapInfo of the same stamp belong together, if they are of one mapper.
void TopicUpdates::apply_full() {
  if (!full_) return;
  const auto found = infos_.find(messages::to_nanoseconds(full_->header().stamp()));
  if (found == infos_.end() || found->second->node_count() * kNodeBytes != full_->data().size()) return;
  const Info info = std::move(found->second);
  infos_.erase(found);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(full_->data().data());
  note(topics::kMapFull.name, replica_.apply(FullMap{{bytes, full_->data().size()},
                                                     full_->resolution(),
                                                     info->map_epoch(),
                                                     info->map_id(),
                                                     info->revision(),
                                                     info->labels(),
                                                     info->label_keys(),
                                                     info->label_values()}));
  full_.reset();
  apply_waiting();
}

void TopicUpdates::apply_waiting() {
  for (;;) {
    const auto [map_id, revision] = replica_.place();
    const auto next = waiting_.find({map_id, revision});
    if (next == waiting_.end()) return;
    const ReplicaAnswer answer = replica_.apply(next->second);
    waiting_.erase(next);
    note(topics::kMapDelta.name, answer);
    if (answer.status != ReplicaStatus::kApplied) return;
  }
}

/// What is old, or has a gap before it, is no fault.
void TopicUpdates::note(const char* topic, const ReplicaAnswer& answer) {
  if (answer.status == ReplicaStatus::kMalformed || answer.status == ReplicaStatus::kOtherResolution)
    context_.diagnostics.reject(topic, service::Rejection::kInvalid, answer.reason);
}

}  // namespace rds::mapper
