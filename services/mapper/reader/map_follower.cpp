// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/reader/map_follower.hpp"

#include <string>
#include <utility>

namespace rds::mapper {

MapFollower::MapFollower(service::ServiceContext& context, std::uint64_t host, MapListener listener)
    : context_(context),
      replica_(std::move(listener)),
      far_(context, topics::kTool, transfer::kMaps, transfer::Stream::kMapUpdates, transfer::Order::kNumber,
           {.item = [this](std::uint64_t map_id, const transfer::Item& item) { take(map_id, item); },
            .where = [this](Where where) { change_over(where); },
            .next = [this](std::uint64_t map_id,
                           const transfer::Offer& offer) { return next(map_id, offer); }},
           host) {}

void MapFollower::change_over(Where where) {
  near_.reset();
  if (where == Where::kHere) near_.emplace(context_, replica_);
  where_ = where;
}

/// From the revision that is here; after an update that could not be had, or was of no use, the whole map.
std::optional<std::uint64_t> MapFollower::next(std::uint64_t map_id, const transfer::Offer& offer) {
  const LiveReplica::Place here = replica_.place();
  std::uint64_t since = here.map_id == map_id ? here.revision : 0;
  if (offer.newest <= since) return std::nullopt;
  if (asked_since_ == since) since = 0;
  asked_since_ = since;
  return update_number({since, offer.newest});
}

void MapFollower::take(std::uint64_t map_id, const transfer::Item& item) {
  auto update = unpack_update(item.bytes);
  const std::uint64_t since = span_of(item.number).since;
  std::string fault = update ? "" : update.error();
  if (update && (update->delta.map_id != map_id || update->delta.base_revision != since))
    fault = "another update than the one that was asked for";
  if (update && fault.empty()) fault = apply(std::move(*update));
  if (!fault.empty())
    return context_.diagnostics.reject(topics::kMapChunks.name, service::Rejection::kInvalid, fault);
  asked_since_.reset();
}

/// @return what is wrong with it; empty if nothing.
std::string MapFollower::apply(MapUpdate update) {
  if (update.delta.base_revision > 0) return replica_.apply(update.delta, std::move(update.labels)).reason;
  OctreeReplica whole;
  const ReplicaAnswer answer = whole.apply(update.delta);
  if (answer.status == ReplicaStatus::kApplied) replica_.replace(std::move(whole), std::move(update.labels));
  return answer.reason;
}

}  // namespace rds::mapper
