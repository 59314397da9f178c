// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "common/service/peers/peers.hpp"

namespace rds::service {

/// Notices that a service of another kind says nothing any more, though it has not said good-bye: it was
/// killed, it hangs, or the way to its machine is cut. Used by one thread.
class PeerWatch {
 public:
  using Clock = Peers::Clock;
  /// One of its statuses is missing. Looked at four times a second, silence is told within 2 s.
  static constexpr std::chrono::milliseconds kSilentAfter{1750};

  /// Logs who falls silent and who is heard again. @param known  as Peers::known().
  /// @return "rds-mapper on nas has been silent for 3 s", of the one that has been silent for longest;
  /// nullopt if none is.
  std::optional<std::string> look(std::span<const Peer> known, Clock::time_point now);

 private:
  static constexpr std::size_t kMostKinds = 16;
  /// Without a look for so long this process itself was stopped, and what it did not hear says nothing.
  static constexpr std::chrono::seconds kStoppedAfter{1};

  struct Seen {
    std::string name;  // with its machine
    Clock::time_point heard;
    bool is_silent = false;
  };
  void learn(std::span<const Peer> known);

  std::map<std::string, Seen> seen_;  // by kind of service
  Clock::time_point looked_{};
  Clock::time_point resumed_{};
};

}  // namespace rds::service
