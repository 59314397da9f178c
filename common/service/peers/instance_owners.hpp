// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>

#include "common/bus/participant.hpp"

namespace rds::service {

/// Which participant of the bus speaks for each instance of a service: the first one that was heard with it.
/// A copy of a message, spoiled or old, that another program writes is known by that. Safe to use from any
/// thread.
class InstanceOwners {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMost = 256;            // instances
  static constexpr std::chrono::seconds kIdleFor{60};  // then an instance makes room for others

  /// Whether this participant speaks for the instance. Where all places are taken nobody new does.
  bool owns(const bus::ParticipantId& writer, std::uint64_t instance, Clock::time_point now = Clock::now()) {
    const std::lock_guard lock(mutex_);
    if (owners_.size() >= kMost)
      std::erase_if(owners_, [&](const auto& entry) { return now - entry.second.heard > kIdleFor; });
    const bool has_room = owners_.size() < kMost;
    const auto owner =
        has_room ? owners_.try_emplace(instance, Owner{writer, now}).first : owners_.find(instance);
    if (owner == owners_.end() || owner->second.participant != writer) return false;
    owner->second.heard = now;
    return true;
  }

  /// A callback that calls `take` with the messages whose writer speaks for the instance they name, and
  /// `refuse` for each of the others.
  template <class Take, class Refuse>
  auto only_owned(Take take, Refuse refuse) {
    return [this, take, refuse](const auto& message, const bus::ParticipantId& writer) {
      if (owns(writer, message->instance()))
        take(message);
      else
        refuse();
    };
  }

 private:
  struct Owner {
    bus::ParticipantId participant{};
    Clock::time_point heard;
  };
  std::mutex mutex_;
  std::map<std::uint64_t, Owner> owners_;
};

}  // namespace rds::service
