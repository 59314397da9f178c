// SPDX-License-Identifier: Apache-2.0
#include "tests/support/map_reader.hpp"

#include "common/messages/conversions.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"

namespace rds::test {
namespace {

constexpr std::size_t kNodeBytes = 8;

mapper::MapDelta to_delta(const rds_msgs::msg::OctreeDelta& m) {
  mapper::MapDelta delta;
  delta.map_epoch = m.map_epoch();
  delta.map_id = m.map_id();
  delta.base_revision = m.base_revision();
  delta.revision = m.revision();
  delta.resolution = m.resolution();
  delta.keys = m.keys();
  delta.log_odds = m.log_odds();
  delta.labels = m.labels();
  delta.colors = m.colors();
  delta.deleted_keys = m.deleted_keys();
  return delta;
}

}  // namespace

MapReader::MapReader(bus::Participant& bus) {
  subscriptions_.push_back(bus.subscribe<octomap_msgs::msg::Octomap>("rds/map/full", bus::kLatched,
                                                                     [this](const auto& m) { on_full(m); }));
  subscriptions_.push_back(bus.subscribe<rds_msgs::msg::MapInfo>("rds/map/info", bus::kLatchedEvery,
                                                                 [this](const auto& m) { on_info(m); }));
  subscriptions_.push_back(bus.subscribe<rds_msgs::msg::OctreeDelta>(
      "rds/map/delta", bus::kDelta, [this](const auto& m) { on_delta(*m); }));
}

std::vector<std::uint8_t> MapReader::bytes() {
  const std::lock_guard lock(mutex_);
  return replica_.is_valid() ? mapper::to_bytes(replica_.tree()) : std::vector<std::uint8_t>{};
}

std::uint64_t MapReader::revision() {
  const std::lock_guard lock(mutex_);
  return replica_.revision();
}

std::uint64_t MapReader::map_id() {
  const std::lock_guard lock(mutex_);
  return replica_.map_id();
}

std::size_t MapReader::labelled() {
  const std::lock_guard lock(mutex_);
  std::size_t count = 0;
  if (!replica_.is_valid()) return count;
  for (auto leaf = replica_.tree().begin_leafs(), end = replica_.tree().end_leafs(); leaf != end; ++leaf)
    count += replica_.label(leaf.getKey()) != 0 ? 1U : 0U;
  return count;
}

int MapReader::full_maps() {
  const std::lock_guard lock(mutex_);
  return full_maps_;
}

int MapReader::deltas() {
  const std::lock_guard lock(mutex_);
  return deltas_;
}

void MapReader::on_full(std::shared_ptr<const octomap_msgs::msg::Octomap> message) {
  const std::lock_guard lock(mutex_);
  full_ = std::move(message);
  take_full();
}

/// Another mapper may give the stamp of an earlier one's map again: what is told of that one is over.
void MapReader::on_info(std::shared_ptr<const rds_msgs::msg::MapInfo> message) {
  const std::lock_guard lock(mutex_);
  std::erase_if(infos_, [&](const auto& told) { return told.second->map_id() != message->map_id(); });
  if (!message->describes_full()) return;
  infos_[messages::to_nanoseconds(message->header().stamp())] = std::move(message);
  take_full();
}

void MapReader::on_delta(const rds_msgs::msg::OctreeDelta& message) {
  const std::lock_guard lock(mutex_);
  waiting_[{message.map_id(), message.base_revision()}] = to_delta(message);
  if (message.base_revision() == 0) {  // the first of a map
    if (replica_.apply(waiting_.at({message.map_id(), 0})).status == mapper::ReplicaStatus::kApplied)
      ++deltas_;
  }
  apply_waiting();
}

/// The full map and the MapInfo of the same stamp belong together, if they are of one mapper.
void MapReader::take_full() {
  if (!full_) return;
  const auto found = infos_.find(messages::to_nanoseconds(full_->header().stamp()));
  if (found == infos_.end() || found->second->node_count() * kNodeBytes != full_->data().size()) return;
  const auto described = std::move(found->second);
  infos_.erase(found);
  const rds_msgs::msg::MapInfo& info = *described;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(full_->data().data());
  const auto answer = replica_.apply(mapper::FullMap{{bytes, full_->data().size()},
                                                     full_->resolution(),
                                                     info.map_epoch(),
                                                     info.map_id(),
                                                     info.revision(),
                                                     info.labels(),
                                                     info.label_keys(),
                                                     info.label_values()});
  if (answer.status == mapper::ReplicaStatus::kApplied) ++full_maps_;
  full_.reset();
  apply_waiting();
}

void MapReader::apply_waiting() {
  while (replica_.is_valid()) {
    const auto next = waiting_.find({replica_.map_id(), replica_.revision()});
    if (next == waiting_.end() || replica_.apply(next->second).status != mapper::ReplicaStatus::kApplied)
      return;
    ++deltas_;
  }
}

}  // namespace rds::test
