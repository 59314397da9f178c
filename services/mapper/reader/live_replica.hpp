// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "services/mapper/core/octree/octree_replica.hpp"

namespace rds::mapper {

/// Told, on the thread that updates, what was applied: a delta, or nullptr for a whole map in place of all
/// that was there. It must not look() itself.
using MapListener = std::function<void(const MapDelta* applied)>;

/// A replica of the map and its label table, for threads that update and threads that look.
class LiveReplica {
 public:
  explicit LiveReplica(MapListener listener = {}) : listener_(std::move(listener)) {}

  ReplicaAnswer apply(const FullMap& full) {
    const std::lock_guard lock(mutex_);
    auto answer = replica_.apply(full);
    if (answer.status != ReplicaStatus::kApplied) return answer;
    labels_.assign(full.labels.begin(), full.labels.end());
    tell(nullptr);
    return answer;
  }
  ReplicaAnswer apply(const MapDelta& delta) {
    const std::lock_guard lock(mutex_);
    auto answer = replica_.apply(delta);
    if (answer.status == ReplicaStatus::kApplied) tell(delta.base_revision == 0 ? nullptr : &delta);
    return answer;
  }
  ReplicaAnswer apply(const MapDelta& delta, std::vector<std::string> labels) {
    const std::lock_guard lock(mutex_);
    auto answer = replica_.apply(delta);
    if (answer.status != ReplicaStatus::kApplied) return answer;
    labels_ = std::move(labels);
    tell(delta.base_revision == 0 ? nullptr : &delta);
    return answer;
  }
  void replace(OctreeReplica replica, std::vector<std::string> labels) {
    const std::lock_guard lock(mutex_);
    std::swap(replica_, replica);
    labels_ = std::move(labels);
    tell(nullptr);
  }

  /// The label table of a map as it is told beside its deltas; another map's is left.
  void tell_labels(std::uint64_t map_id, const std::vector<std::string>& labels) {
    const std::lock_guard lock(mutex_);
    if (!replica_.is_valid() || replica_.map_id() != map_id || labels == labels_) return;
    labels_ = labels;
    static const MapDelta kNoVoxels;
    tell(&kNoVoxels);
  }

  /// Of which map it is, and how far; zeros without one.
  struct Place {
    std::uint64_t map_id = 0;
    std::uint64_t revision = 0;
  };
  [[nodiscard]] Place place() const {
    const std::lock_guard lock(mutex_);
    return {replica_.map_id(), replica_.revision()};
  }

  /// Calls visit(replica, labels) while nobody updates it. @return false without a map: nothing was called.
  template <class Visit>
  bool look(const Visit& visit) const {
    const std::lock_guard lock(mutex_);
    if (replica_.is_valid()) visit(replica_, labels_);
    return replica_.is_valid();
  }

 private:
  void tell(const MapDelta* applied) const {
    if (listener_) listener_(applied);
  }

  MapListener listener_;
  mutable std::mutex mutex_;
  OctreeReplica replica_;
  std::vector<std::string> labels_;
};

}  // namespace rds::mapper
