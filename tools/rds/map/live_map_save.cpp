// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/map/live_map_save.hpp"

#include <algorithm>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/map_file/atomic_file.hpp"
#include "common/map_file/saved_map.hpp"
#include "common/service/random_id.hpp"
#include "tools/rds/commander/commander.hpp"
#include "tools/rds/commander/topology.hpp"

namespace rds::tools {
namespace fs = std::filesystem;
namespace {

using Answer = tl::expected<std::string, std::string>;
using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kStatusTime{300};
constexpr std::chrono::seconds kCommandTime{90};  // longer than a service takes to give up

std::string random_id() {
  return fmt::format("{:016x}", service::random_id());
}

/// The services with a part of the map that answer before the deadline; all three end the wait.
std::vector<std::string> wait_for_services(run::Commander& commander, Clock::time_point deadline,
                                           const std::stop_token& stop) {
  std::vector<std::string> there;
  while (there.size() < 3 && Clock::now() < deadline && !stop.stop_requested()) {
    there.clear();
    const auto answers = commander.ask_status(5, stop, kStatusTime);
    for (const std::string& name : {run::kTracker, run::kMapper, run::kLoopCloser})
      if (answers.contains(name)) there.push_back(name);
  }
  return there;
}

tl::expected<std::vector<std::string>, std::string> find_services(run::Commander& commander,
                                                                  std::chrono::duration<double> timeout,
                                                                  const std::stop_token& stop) {
  auto services =
      wait_for_services(commander, Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout), stop);
  for (const std::string& needed : {run::kTracker, run::kMapper})
    if (std::ranges::find(services, needed) == services.end())
      return tl::unexpected(fmt::format("{} does not answer, expected it to be running", needed));
  return services;
}

Answer ask(run::Commander& commander, const std::string& service, const std::string& verb,
           const std::string& argument, const std::stop_token& stop) {
  const auto reply = commander.ask(service, verb, argument, stop, kCommandTime);
  if (!reply)
    return tl::unexpected(fmt::format("{}: no answer to '{}' in {} s", service, verb, kCommandTime.count()));
  if (!reply->success) return tl::unexpected(fmt::format("{}: {}", service, reply->message));
  return reply->message;
}

}  // namespace

tl::expected<LiveSave, std::string> save_live_map(bus::Participant& participant, const std::string& name,
                                                  std::chrono::duration<double> timeout,
                                                  const std::stop_token& stop) {
  run::Commander commander(participant);
  const auto services = find_services(commander, timeout, stop);
  if (!services) return tl::unexpected(services.error());
  nlohmann::json order{{"name", name}, {"id", random_id()}, {"parts", nlohmann::json::array()}};
  for (const std::string& service : *services) order["parts"].push_back(run::part_of(service));
  LiveSave saved;
  bool published = false;
  for (const std::string& service : *services) {
    const Answer answer = ask(commander, service, "save", order.dump(), stop);
    if (!answer) return tl::unexpected(answer.error());
    const auto json = nlohmann::json::parse(*answer, nullptr, false);
    if (!json.is_object()) return tl::unexpected(fmt::format("{}: answered in another form", service));
    published |= json.value("state", "") == "published";
    saved.folder = json.value("folder", "");
    saved.by_service[service] = json.value("saved", "");
  }
  if (!published) return tl::unexpected(fmt::format("{}: its parts do not lie in one folder of maps", name));
  return saved;
}

tl::expected<void, std::string> save_live_map_as(bus::Participant& participant, const fs::path& file,
                                                 std::chrono::duration<double> timeout,
                                                 const std::stop_token& stop) {
  const std::string name = "for-rds-map-save-" + random_id();
  const auto saved = save_live_map(participant, name, timeout, stop);
  if (!saved) return tl::unexpected(saved.error());
  const auto bytes = map_file::read_regular_file(saved->folder / map_file::kMapFile);
  if (!bytes)
    return tl::unexpected(
        fmt::format("{}: the services' folder of maps cannot be read from here ({}); the map is there as {}",
                    (saved->folder / map_file::kMapFile).string(), bytes.error(), name));
  auto written = map_file::write_atomically(file, *bytes);
  std::error_code ignored;
  if (written) fs::remove_all(saved->folder, ignored);
  return written;
}

tl::expected<std::map<std::string, std::string>, std::string> load_live_map(
    bus::Participant& participant, const std::string& name, std::chrono::duration<double> timeout,
    const std::stop_token& stop) {
  run::Commander commander(participant);
  const auto services = find_services(commander, timeout, stop);
  if (!services) return tl::unexpected(services.error());
  std::map<std::string, std::string> answers;
  for (const std::string& service : *services) {
    const Answer answer = ask(commander, service, "load", name, stop);
    if (!answer) return tl::unexpected(answer.error());
    answers[service] = *answer;
  }
  return answers;
}

}  // namespace rds::tools
