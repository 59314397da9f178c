// SPDX-License-Identifier: Apache-2.0
#include "common/service/ros/bond.hpp"

#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "common/messages/conversions.hpp"

namespace rds::service {
namespace {

using bond::msg::Status;

const std::string kTopic = "bond";  // of packages of ROS, so in no table
const std::string kOurs = "rds-";   // two processes of ours never answer each other
constexpr double kHeartbeatPeriodS = 0.1;
constexpr bus::Qos kHeartbeats{.reliable = true, .depth = 100};

}  // namespace

Bond::Bond(bus::Participant& bus, std::string id, std::uint64_t instance, std::function<bool()> lives)
    : id_(std::move(id)),
      instance_(fmt::format("{}{:016x}", kOurs, instance)),
      lives_(std::move(lives)),
      publisher_(bus.advertise<Status>(kTopic, kHeartbeats)),
      subscription_(bus.subscribe<Status>(kTopic, kHeartbeats, [this](const auto& m) { take(*m); })) {}

/// @return whether the node lives; nullopt where the manager is not to hear anything.
std::optional<bool> Bond::answer_to(const Status& heartbeat) {
  if (heartbeat.id() != id_ || heartbeat.instance_id().starts_with(kOurs)) return std::nullopt;
  const bool lives = lives_();
  const std::lock_guard lock(mutex_);
  const bool is_bound = manager_ == heartbeat.instance_id();
  if (heartbeat.active() && lives) {
    manager_ = heartbeat.instance_id();
    return true;
  }
  if (is_bound) manager_.clear();
  return is_bound ? std::optional(false) : std::nullopt;  // said once, as is that a manager's end is heard
}

void Bond::take(const Status& heartbeat) {
  const auto answer = answer_to(heartbeat);
  if (!answer) return;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  Status status;
  status.header(messages::make_header(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count(), ""));
  status.id(id_);
  status.instance_id(instance_);
  status.active(*answer);
  status.heartbeat_timeout(static_cast<float>(kHeartbeatTimeoutS));
  status.heartbeat_period(static_cast<float>(kHeartbeatPeriodS));
  publisher_.write(status);
}

}  // namespace rds::service
