// SPDX-License-Identifier: Apache-2.0
#include "common/service/peers/peer_watch.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "common/service/process/printable.hpp"

namespace rds::service {
namespace {

namespace Role = rds_msgs::msg::ServiceStatus_Constants;

std::string name_of(const std::string& kind, const std::string& machine) {
  return machine.empty() ? printable(kind, 32)
                         : fmt::format("{} on {}", printable(kind, 32), printable(machine, 64));
}

}  // namespace

/// Of each kind the one that was heard last counts: after a restart that is the new one.
void PeerWatch::learn(std::span<const Peer> known) {
  std::map<std::string, const Peer*> newest;
  for (const Peer& peer : known) {
    const Peer*& best = newest[peer.status.service()];
    if (best == nullptr || peer.heard > best->heard) best = &peer;
  }
  for (const auto& [kind, peer] : newest) {
    if (peer->status.role() == Role::STOPPED) {
      seen_.erase(kind);
    } else if (seen_.contains(kind) || seen_.size() < kMostKinds) {
      Seen& seen = seen_[kind];
      seen.machine = peer->status.machine();
      seen.heard = std::max(seen.heard, peer->heard);
    }
  }
}

std::optional<std::string> PeerWatch::look(std::span<const Peer> known, Clock::time_point now) {
  if (now - looked_ > kStoppedAfter) resumed_ = now;
  looked_ = now;
  learn(known);
  std::optional<std::string> worst;
  Clock::duration longest = kSilentAfter;
  for (auto& [kind, seen] : seen_) {
    const Clock::duration silent = now - std::max(seen.heard, resumed_);
    const bool was_silent = std::exchange(seen.is_silent, silent > kSilentAfter);
    const std::string name = name_of(kind, seen.machine);
    if (seen.is_silent && !was_silent) spdlog::warn("{} is silent: killed, hanging, or out of reach", name);
    if (!seen.is_silent && was_silent) spdlog::info("{} is heard again", name);
    if (silent <= longest) continue;
    longest = silent;
    worst =
        fmt::format("{} has been silent for {:.0f} s", name, std::chrono::duration<double>(silent).count());
  }
  return worst;
}

}  // namespace rds::service
