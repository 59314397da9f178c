// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "services/mapper/core/octree/octree_replica.hpp"

namespace rds::mapper {

/// A replica of the map and its label table, for threads that update and threads that look.
class LiveReplica {
 public:
  ReplicaAnswer apply(const FullMap& full) {
    const std::lock_guard lock(mutex_);
    auto answer = replica_.apply(full);
    if (answer.status == ReplicaStatus::kApplied) labels_.assign(full.labels.begin(), full.labels.end());
    return answer;
  }
  ReplicaAnswer apply(const MapDelta& delta) {
    const std::lock_guard lock(mutex_);
    return replica_.apply(delta);
  }
  ReplicaAnswer apply(const MapDelta& delta, std::vector<std::string> labels) {
    const std::lock_guard lock(mutex_);
    auto answer = replica_.apply(delta);
    if (answer.status == ReplicaStatus::kApplied) labels_ = std::move(labels);
    return answer;
  }
  void replace(OctreeReplica replica, std::vector<std::string> labels) {
    const std::lock_guard lock(mutex_);
    std::swap(replica_, replica);
    labels_ = std::move(labels);
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
  mutable std::mutex mutex_;
  OctreeReplica replica_;
  std::vector<std::string> labels_;
};

}  // namespace rds::mapper
