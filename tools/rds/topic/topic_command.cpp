// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/messages/json.hpp"
#include "tools/rds/cli/bus_options.hpp"
#include "tools/rds/cli/commands.hpp"
#include "tools/rds/cli/exit.hpp"
#include "tools/rds/cli/interrupt.hpp"
#include "tools/rds/cli/wait.hpp"
#include "tools/rds/topic/topic_reader.hpp"
#include "tools/rds/topic/topic_report.hpp"
#include "tools/rds/topic/topic_table.hpp"

namespace rds::tools {
namespace {

struct TopicOptions {
  BusOptions bus;
  std::string topic;
  double timeout_s = 10;
  double discovery_s = 2;
  double measure_s = 5;
  std::size_t count = 0;
  bool full = false;
  bool json = false;
};

constexpr std::size_t kLongestList = 8;
constexpr std::chrono::hours kForever{24 * 365};

Clock::duration seconds(double value) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(value));
}

/// Joins the bus and ends the subcommand with a sentence if that fails.
std::unique_ptr<bus::Participant> join(const BusOptions& options) {
  try {
    return bus::Participant::create(options.participant("rds_topic"));
  } catch (const bus::BusError& e) {
    exit_with(kExitFault, e.what());
  }
}

std::unique_ptr<TopicReader> read_topic(bus::Participant& participant, const TopicOptions& options,
                                        bool keep_messages, const std::stop_token& stop) {
  // Also with a leading slash, as ROS 2 writes topics.
  const std::string topic = options.topic.substr(options.topic.starts_with('/') ? 1 : 0);
  auto reader =
      TopicReader::open(participant, topic, keep_messages, Clock::now() + seconds(options.timeout_s), stop);
  if (!reader) exit_with(kExitFault, reader.error());
  return std::move(*reader);
}

void list(const TopicOptions& options) {
  const Interrupt interrupt;
  const auto participant = join(options.bus);
  wait_until(Clock::now() + seconds(options.discovery_s), interrupt.token(), [] { return false; });
  const auto topics = summarise(participant->discovered());
  if (topics.empty() && !options.bus.peers.empty())
    exit_with(kExitFault, fmt::format("nobody was heard of in {} s", options.discovery_s));
  auto json = nlohmann::ordered_json::array();
  for (const auto& topic : topics) {
    if (options.json)
      json.push_back({{"topic", topic.topic},
                      {"type", topic.type},
                      {"publishers", topic.publishers},
                      {"subscribers", topic.subscribers}});
    else
      fmt::print("{:<44} {:<36} {} publishers, {} subscribers\n", topic.topic, topic.type, topic.publishers,
                 topic.subscribers);
  }
  if (options.json) fmt::print("{}\n", messages::to_text(json));
}

void echo(const TopicOptions& options) {
  const Interrupt interrupt;
  const auto participant = join(options.bus);
  const auto reader = read_topic(*participant, options, true, interrupt.token());
  auto deadline = Clock::now() + seconds(options.timeout_s);
  std::size_t seen = 0;
  while (options.count == 0 || seen < options.count) {
    const auto arrival = reader->next(deadline, interrupt.token());
    if (!arrival) break;
    const auto json = reader->type().to_json(arrival->message.get());
    fmt::print("{}\n", messages::to_text(options.full ? json : shortened(json, kLongestList)));
    std::fflush(stdout);
    ++seen;
    if (options.count == 0) deadline = Clock::now() + kForever;
  }
  if (reader->dropped() > 0)
    fmt::print(stderr, "rds: {} messages came too fast to be shown\n", reader->dropped());
  if (seen < std::max<std::size_t>(1, options.count) && !interrupt.token().stop_requested())
    exit_with(kExitFault, fmt::format("{}: {} messages in {} s, expected {}", options.topic, seen,
                                      options.timeout_s, std::max<std::size_t>(1, options.count)));
}

using Report = std::string (*)(std::span<const Arrival>);

void measure(const TopicOptions& options, Report report) {
  const Interrupt interrupt;
  const auto participant = join(options.bus);
  const auto reader = read_topic(*participant, options, false, interrupt.token());
  const auto first = reader->next(Clock::now() + seconds(options.timeout_s), interrupt.token());
  if (!first) {
    if (interrupt.token().stop_requested()) return;
    exit_with(kExitFault, fmt::format("{}: no message in {} s", options.topic, options.timeout_s));
  }
  std::vector<Arrival> arrivals{*first};
  const auto end = first->time + seconds(options.measure_s);
  while (const auto arrival = reader->next(end, interrupt.token())) arrivals.push_back(*arrival);
  fmt::print("{}\n", report(arrivals));
}

CLI::App* add_reading_command(CLI::App& topic, const std::string& name, const std::string& description,
                              const std::shared_ptr<TopicOptions>& options) {
  auto* command = topic.add_subcommand(name, description);
  command->add_option("topic", options->topic, "Name without \"rt/\", e.g. rds/odometry")->required();
  command->add_option("--timeout", options->timeout_s, "Wait so long for a publisher, then for a message [s]")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  add_bus_options(*command, options->bus);
  return command;
}

void add_measuring_command(CLI::App& topic, const std::string& name, const std::string& description,
                           Report report) {
  const auto options = std::make_shared<TopicOptions>();
  auto* command = add_reading_command(topic, name, description, options);
  command->add_option("--seconds", options->measure_s, "Measure so long from the first message on [s]")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str();
  command->callback([options, report] { measure(*options, report); });
}

void add_list_command(CLI::App& topic) {
  const auto options = std::make_shared<TopicOptions>();
  auto* command = topic.add_subcommand("list", "Topics with their types and numbers of endpoints");
  command->add_option("--timeout", options->discovery_s, "Listen so long [s]")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print one line of JSON");
  add_bus_options(*command, options->bus);
  command->callback([options] { list(*options); });
}

void add_echo_command(CLI::App& topic) {
  const auto options = std::make_shared<TopicOptions>();
  auto* command = add_reading_command(topic, "echo", "Messages as lines of JSON", options);
  command->add_option("--count", options->count, "End after so many messages (default: never)")
      ->check(CLI::Range(1, 1'000'000'000));
  command->add_flag("--full", options->full, "Print long lists whole");
  command->callback([options] { echo(*options); });
}

}  // namespace

void add_topic_command(CLI::App& rds) {
  auto* topic = rds.add_subcommand("topic", "Look at the topics of the live bus");
  topic->require_subcommand(1);
  add_list_command(*topic);
  add_echo_command(*topic);
  add_measuring_command(*topic, "hz", "Rate of a topic's messages", rate_report);
  add_measuring_command(*topic, "bw", "Bandwidth of a topic's messages", bandwidth_report);
  topic->add_subcommand("table", "The topics that RDS-SLAM knows, as a table of Markdown")->callback([] {
    fmt::print("{}", topic_table());
  });
}

}  // namespace rds::tools
