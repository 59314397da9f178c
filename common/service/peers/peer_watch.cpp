// SPDX-License-Identifier: Apache-2.0
#include "common/service/peers/peer_watch.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace rds::service {
namespace {

namespace Role = rds_msgs::msg::ServiceStatus_Constants;

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
      seen.name = name_of(peer->status);
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
    if (seen.is_silent && !was_silent)
      spdlog::warn("{} is silent: killed, hanging, or out of reach", seen.name);
    if (!seen.is_silent && was_silent) spdlog::info("{} is heard again", seen.name);
    if (silent <= longest) continue;
    longest = silent;
    worst = fmt::format("{} has been silent for {:.0f} s", seen.name,
                        std::chrono::duration<double>(silent).count());
  }
  return worst;
}

}  // namespace rds::service
