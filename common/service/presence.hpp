// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/service/peers/election.hpp"
#include "common/service/peers/peers.hpp"
#include "common/service/service.hpp"

namespace rds::service {

/// How a service is; the levels of diagnostic_msgs/DiagnosticStatus.
struct Health {
  std::uint8_t level = 0;
  std::string message;
};
inline constexpr std::uint8_t kOk = 0;
inline constexpr std::uint8_t kWarn = 1;
inline constexpr std::uint8_t kError = 2;

/// This process among the services on the bus: tells of itself on rds/services, and knows whether another of
/// its kind is there. Safe to use from any thread.
class Presence {
 public:
  /// @param changed  called on a bus thread when another service came, left or changed its role.
  Presence(ServiceContext& context, std::function<void()> changed);

  /// Begins or ends to be the active one.
  void set_active(bool active);
  [[nodiscard]] bool is_active() const { return active_; }
  /// Whether it should be: see election.hpp.
  [[nodiscard]] bool should_be_active() const;
  [[nodiscard]] const Peers& peers() const { return peers_; }
  /// "another rds-mapper … is in this domain", or nothing.
  [[nodiscard]] std::optional<std::string> rivalry() const;

  void tell(const Health& health, double worker_silent_s);
  void say_goodbye();

 private:
  [[nodiscard]] std::vector<Candidate> rivals() const;
  [[nodiscard]] double active_s() const;
  void write(std::uint8_t role, const Health& health, double worker_silent_s);

  ServiceContext& context_;
  std::atomic<bool> active_ = false;
  std::atomic<std::chrono::steady_clock::time_point> active_since_;
  bus::Publisher<rds_msgs::msg::ServiceStatus> publisher_;
  Peers peers_;
};

}  // namespace rds::service
