// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/messages/json.hpp"
#include "common/topics/topics.hpp"
#include "tools/rds/cli/bus_options.hpp"
#include "tools/rds/cli/commands.hpp"
#include "tools/rds/cli/exit.hpp"
#include "tools/rds/cli/interrupt.hpp"
#include "tools/rds/cli/wait.hpp"
#include "tools/rds/status/service_report.hpp"

namespace rds::tools {
namespace {

using Clock = service::Peers::Clock;

struct StatusOptions {
  BusOptions bus;
  std::vector<std::string> services;
  double wait_s = 5;  // who has missed a participant's first announcements hears the next after 3 s
  bool json = false;
};

const std::vector<std::string> kAllServices{"rds-tracker", "rds-detector", "rds-transformer", "rds-mapper",
                                            "rds-loop-closer"};

/// The names that are expected; all five if none was given.
std::vector<std::string> expected_services(const StatusOptions& options) {
  std::vector<std::string> expected;
  for (const auto& name : options.services) expected.push_back(service_name(name));
  return expected.empty() ? kAllServices : expected;
}

/// Those that are asked for, if any are, else all that are there.
std::vector<service::Peer> rows(std::vector<service::Peer> present, const StatusOptions& options) {
  if (options.services.empty()) return present;
  const auto expected = expected_services(options);
  std::erase_if(present, [&](const service::Peer& peer) {
    return std::ranges::find(expected, peer.status.service()) == expected.end();
  });
  return present;
}

/// Services say what they lack once a second.
constexpr std::chrono::seconds kFiguresWithin{2};

/// Whether diagnostics of all these have come.
bool has_heard_all(const ServiceReport& report) {
  return std::ranges::all_of(report.services, [&](const service::Peer& peer) {
    return report.transfers.contains(peer.status.instance());
  });
}

/// Listens until all is well or the time is over. Only what is said now counts, not a latched status of
/// before: a process that is stopped may have left one.
ServiceReport listen(const StatusOptions& options) {
  const Interrupt interrupt;
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(options.wait_s));
  const auto participant = bus::Participant::create(options.bus.participant("rds_status"));
  const service::Peers peers(*participant, {}, bus::kStream);
  TransfersHeard transfers;
  const auto diagnostics = participant->subscribe<diagnostic_msgs::msg::DiagnosticArray>(
      topics::kDiagnostics.address(), bus::kStream, [&](const auto& heard) { transfers.take(*heard); });
  const auto expected = expected_services(options);
  ServiceReport report;
  std::optional<Clock::time_point> well_since;
  wait_until(deadline, interrupt.token(), [&] {
    report = report_on(rows(peers.present(), options), expected, Clock::now());
    report.transfers = transfers.figures();
    if (!report.problems.empty()) return false;
    if (!well_since) well_since = Clock::now();
    return has_heard_all(report) || Clock::now() - *well_since >= kFiguresWithin;
  });
  return report;
}

void show_status(const StatusOptions& options) {
  ServiceReport report;
  try {
    report = listen(options);
  } catch (const bus::BusError& e) {
    exit_with(kExitFault, e.what());
  }
  if (options.json)
    fmt::print("{}\n", messages::to_text(as_json(report)));
  else
    fmt::print("{}", as_table(report));
  if (!report.problems.empty()) exit_with(kExitFault, fmt::format("{}", fmt::join(report.problems, "; ")));
}

}  // namespace

void add_status_command(CLI::App& rds) {
  const auto options = std::make_shared<StatusOptions>();
  auto* command =
      rds.add_subcommand("status", "Whether the services are there and well; exit status 1 if not");
  command->add_option("--service", options->services,
                      "Only this one, e.g. tracker; may be given again (default: all five)");
  command->add_option("--wait", options->wait_s, "Listen until all is well, at most so long [s]")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print one line of JSON");
  add_bus_options(*command, options->bus);
  command->callback([options] { show_status(*options); });
}

}  // namespace rds::tools
