// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/service/peers/peers.hpp"
#include "tools/rds/status/transfer_figures.hpp"

namespace rds::tools {

/// Who of the services is there, and what is wrong with those that are expected.
struct ServiceReport {
  std::vector<service::Peer> services;
  std::vector<std::string> problems;  // one sentence each; empty if all is well
  TransfersHeard::Figures transfers;
};

/// "tracker", "loop_closer" and "rds-tracker" as the services call themselves: "rds-tracker",
/// "rds-loop-closer".
std::string service_name(std::string name);

/// All is well if each expected service is there once, active, without an error, and heard of in the last 3
/// s.
///
/// @param present  as Peers::present() at the time `now`.
/// @param expected  names of services, by service_name(); problems are looked for in these alone.
ServiceReport report_on(std::vector<service::Peer> present, std::span<const std::string> expected,
                        service::Peers::Clock::time_point now);

/// One line of 120 columns per service under a heading, then what they say of themselves, a line each; text
/// from the bus made printable.
std::string as_table(const ServiceReport& report);

/// {"well", "services": [{"service", "instance", "role", …, "transfer"}], "problems"}; "transfer" is null
/// where nothing is taken from another machine.
nlohmann::ordered_json as_json(const ServiceReport& report);

}  // namespace rds::tools
