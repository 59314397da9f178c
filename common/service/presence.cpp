// SPDX-License-Identifier: Apache-2.0
#include "common/service/presence.hpp"

#include <array>
#include <climits>

#include <fmt/format.h>
#include <unistd.h>

#include "common/messages/conversions.hpp"
#include "common/topics/endpoints.hpp"

namespace rds::service {
namespace {
namespace Role = rds_msgs::msg::ServiceStatus_Constants;

std::string host_name() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

}  // namespace

Presence::Presence(ServiceContext& context, std::function<void()> changed)
    : context_(context),
      publisher_(topics::advertise(context.bus, topics::kServiceStatus, topics::kServices)),
      peers_(context.bus, std::move(changed)) {}

void Presence::set_active(bool active) {
  active_since_ = std::chrono::steady_clock::now();
  active_ = active;
  tell({}, 0);
}

double Presence::active_s() const {
  if (!active_) return 0;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - active_since_.load()).count();
}

std::vector<Candidate> Presence::rivals() const {
  std::vector<Candidate> rivals;
  for (const auto& [status, heard, clock_ahead_s] : peers_.present())
    if (status.service() == context_.name && status.instance() != context_.instance) {
      const std::chrono::duration<double> since = std::chrono::steady_clock::now() - heard;
      rivals.push_back({status.instance(), status.role() == Role::ACTIVE, status.active_s() + since.count()});
    }
  return rivals;
}

bool Presence::should_be_active() const {
  return shall_be_active({context_.instance, active_, active_s()}, rivals());
}

std::optional<std::string> Presence::rivalry() const {
  const auto others = rivals();
  if (others.empty()) return std::nullopt;
  return fmt::format("another {} is in this domain (instance {:016x}), this one {}", context_.name,
                     others.front().instance, active_ ? "is active" : "waits as stand-by");
}

void Presence::tell(const Health& health, double worker_silent_s) {
  write(active_ ? Role::ACTIVE : Role::STANDBY, health, worker_silent_s);
}

void Presence::say_goodbye() {
  active_ = false;
  write(Role::STOPPED, {}, 0);
}

void Presence::write(std::uint8_t role, const Health& health, double worker_silent_s) {
  rds_msgs::msg::ServiceStatus status;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  status.header(messages::make_header(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count(), ""));
  status.instance(context_.instance);
  status.service(context_.name);
  status.version(RDS_VERSION);
  status.machine(host_name());
  status.role(role);
  status.active_s(active_s());
  status.worker_silent_s(worker_silent_s);
  status.level(health.level);
  status.message(health.message);
  publisher_.write(status);
}

}  // namespace rds::service
