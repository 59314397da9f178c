// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/status/service_report.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "common/service/presence.hpp"
#include "common/service/process/printable.hpp"

namespace rds::tools {
namespace {

namespace Role = rds_msgs::msg::ServiceStatus_Constants;
using service::Peer;
using Seconds = std::chrono::duration<double>;

constexpr Seconds kSilentAfter{3};  // three of a service's statuses are missing

std::string role_name(std::uint8_t role) {
  return role == Role::ACTIVE ? "active" : role == Role::STANDBY ? "stand-by" : "stopped";
}

std::string level_name(std::uint8_t level) {
  return level == service::kOk ? "ok" : level == service::kWarn ? "warn" : "error";
}

std::string short_instance(const Peer& peer) {
  return fmt::format("{:016x}", peer.status.instance()).substr(0, 8);
}

/// As a column; "-" where nothing is known.
std::string shown(double figure) {
  return figure > 0 ? fmt::format("{:.1f}", figure) : "-";
}

std::optional<TransferFigures> transfer_of(const Peer& peer, const ServiceReport& report) {
  const auto found = report.transfers.find(peer.status.instance());
  return found == report.transfers.end() ? std::nullopt : found->second;
}

std::string row(const Peer& peer, const std::optional<TransferFigures>& transfer) {
  const auto& s = peer.status;
  const TransferFigures figures = transfer.value_or(TransferFigures{});
  return fmt::format("{:<16} {:<8} {:<8} {:<8} {:<16} {:>+9.1f} {:>10.1f} {:>5} {:>8} {:>13} {}\n",
                     service::printable(s.service(), 32), short_instance(peer), role_name(s.role()),
                     service::printable(s.version(), 16), service::printable(s.machine(), 32),
                     peer.clock_ahead_s, s.worker_silent_s(),
                     transfer ? std::to_string(figures.lacking) : "-", shown(figures.round_trip_ms),
                     shown(figures.link_mbit_s), level_name(s.level()));
}

void look_at(const std::string& name, std::span<const Peer> present, service::Peers::Clock::time_point now,
             std::vector<std::string>& problems) {
  std::size_t count = 0;
  std::size_t active = 0;
  for (const Peer& peer : present) {
    if (peer.status.service() != name) continue;
    ++count;
    if (peer.status.role() == Role::ACTIVE) ++active;
    if (const Seconds silent = now - peer.heard; silent > kSilentAfter)
      problems.push_back(
          fmt::format("{} ({}) has said nothing for {:.0f} s", name, short_instance(peer), silent.count()));
    if (peer.status.level() >= service::kError)
      problems.push_back(
          fmt::format("{} ({}): {}", name, short_instance(peer), service::printable(peer.status.message())));
  }
  if (count == 0)
    problems.push_back(fmt::format("{} is not there, or says nothing", name));
  else if (count > 1)
    problems.push_back(fmt::format("{} is there {} times, {} of them active", name, count, active));
  else if (active == 0)
    problems.push_back(fmt::format("{} is there as stand-by alone", name));
}

}  // namespace

std::string service_name(std::string name) {
  std::ranges::replace(name, '_', '-');
  return name.starts_with("rds-") ? name : "rds-" + name;
}

ServiceReport report_on(std::vector<Peer> present, std::span<const std::string> expected,
                        service::Peers::Clock::time_point now) {
  ServiceReport report;
  for (const std::string& name : expected) look_at(name, present, now, report.problems);
  report.services = std::move(present);
  return report;
}

std::string as_table(const ServiceReport& report) {
  std::string table = fmt::format("{:<16} {:<8} {:<8} {:<8} {:<16} {:>9} {:>10} {:>5} {:>8} {:>13} {}\n",
                                  "service", "instance", "role", "version", "machine", "clock [s]",
                                  "silent [s]", "lacks", "rtt [ms]", "link [Mbit/s]", "level");
  for (const Peer& peer : report.services) table += row(peer, transfer_of(peer, report));
  for (const Peer& peer : report.services)
    if (!peer.status.message().empty())
      table += fmt::format("{} ({}): {}\n", service::printable(peer.status.service(), 32),
                           short_instance(peer), service::printable(peer.status.message()));
  return table;
}

namespace {

nlohmann::ordered_json as_json(const TransferFigures& transfer) {
  return {{"lacking", transfer.lacking},
          {"round_trip_ms", transfer.round_trip_ms},
          {"link_mbit_s", transfer.link_mbit_s}};
}

}  // namespace

nlohmann::ordered_json as_json(const ServiceReport& report) {
  nlohmann::ordered_json json{{"well", report.problems.empty()},
                              {"services", nlohmann::ordered_json::array()}};
  for (const Peer& peer : report.services) {
    const auto& s = peer.status;
    const auto transfer = transfer_of(peer, report);
    json["services"].push_back({{"service", s.service()},
                                {"instance", fmt::format("{:016x}", s.instance())},
                                {"role", role_name(s.role())},
                                {"version", s.version()},
                                {"machine", s.machine()},
                                {"clock_ahead_s", peer.clock_ahead_s},
                                {"active_s", s.active_s()},
                                {"worker_silent_s", s.worker_silent_s()},
                                {"level", level_name(s.level())},
                                {"message", s.message()},
                                {"transfer", transfer ? as_json(*transfer) : nlohmann::ordered_json()}});
  }
  json["problems"] = report.problems;
  return json;
}

}  // namespace rds::tools
