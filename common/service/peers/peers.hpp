// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/bus/participant.hpp"
#include "common/service/peers/instance_owners.hpp"
#include "rds_msgs/msg/ServiceStatus.h"

namespace rds::service {

/// Kinds of services whose messages are followed.
inline constexpr std::string_view kTracker = "rds-tracker";
inline constexpr std::string_view kMapper = "rds-mapper";
inline constexpr std::string_view kLoopCloser = "rds-loop-closer";

/// A service on the bus, as it tells about itself.
struct Peer {
  rds_msgs::msg::ServiceStatus status;
  std::chrono::steady_clock::time_point heard;
  double clock_ahead_s = 0;  // of its machine, against this one's; what the message took counts as behind
};

/// "rds-mapper on nas", printable.
std::string name_of(const rds_msgs::msg::ServiceStatus& status);

/// Who of the services is on the bus, from their statuses. Safe to use from any thread.
class Peers {
 public:
  using Clock = std::chrono::steady_clock;
  /// A service that has been silent for longer is gone: five of its statuses are missing.
  static constexpr std::chrono::seconds kGoneAfter{5};
  /// … or after two, where another of its kind is there: it was started again.
  static constexpr std::chrono::milliseconds kReplacedAfter{2500};

  /// @param changed  called on a bus thread after each status that tells of another role; may be empty.
  /// @param qos  kStream: only what is said from now on counts, not a last status that a service has left.
  explicit Peers(bus::Participant& bus, std::function<void()> changed = {},
                 const bus::Qos& qos = bus::kLatchedOfEach);

  /// Whether an active service of this instance has been heard of lately.
  [[nodiscard]] bool is_there(std::uint64_t instance) const;
  /// Whether any of this kind has.
  [[nodiscard]] bool has_active(std::string_view kind) const;
  /// Whether any service but this one has been heard of lately, and has not left.
  [[nodiscard]] bool hears_another_than(std::uint64_t instance) const;
  /// Since its last status; nullopt if none was heard.
  [[nodiscard]] std::optional<Clock::duration> silent_for(std::uint64_t instance) const;
  /// As name_of(); nullopt if it is not known.
  [[nodiscard]] std::optional<std::string> name_of(std::uint64_t instance) const;
  /// Whether it said good-bye.
  [[nodiscard]] bool has_left(std::uint64_t instance) const;
  /// All that are remembered, those too that are silent or have left.
  [[nodiscard]] std::vector<Peer> known() const;
  /// All that were heard of lately and have not left, by service and instance.
  [[nodiscard]] std::vector<Peer> present() const;

 private:
  static bool is_active(const Peer& peer);
  static bool is_present(const Peer& peer);
  void take(const rds_msgs::msg::ServiceStatus& status);
  void forget_silent();  // under the lock

  std::function<void()> changed_;
  InstanceOwners owners_;
  mutable std::mutex mutex_;
  std::map<std::uint64_t, Peer> peers_;  // by instance; at most kMaxPeers
  bus::Subscription subscription_;       // last: its callback uses the members above
};

/// Whose messages of one kind a reader uses: those of the first writer that it hears, until that one is gone
/// and another speaks. A service that tells of itself on rds/services goes before a writer that does not (a
/// recording that is played, another program). Owned by one thread.
class FollowedWriter {
 public:
  /// @param kind  of service that writes these messages.
  FollowedWriter(bus::Participant& bus, std::string_view kind) : kind_(kind), peers_(bus) {}

  /// Whether a message of this instance is to be used; then it is the one that is followed from now on.
  ///
  /// @param same_map  the message goes on with the map that the reader knows: a service that was started
  /// again in the place of the one that was followed is taken at once.
  bool accept(std::uint64_t instance, bool same_map);
  /// "rds-mapper on nas", the kind alone of one that says nothing of itself. Of any thread.
  [[nodiscard]] std::string name_of(std::uint64_t instance) const {
    return peers_.name_of(instance).value_or(std::string(kind_));
  }

 private:
  [[nodiscard]] bool may_replace(std::uint64_t newcomer, bool same_map) const;
  [[nodiscard]] bool is_gone(std::uint64_t newcomer) const;

  std::string_view kind_;
  Peers peers_;
  bool follows_ = false;
  std::uint64_t followed_ = 0;
  Peers::Clock::time_point last_used_;
};

}  // namespace rds::service
