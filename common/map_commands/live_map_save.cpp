// SPDX-License-Identifier: Apache-2.0
#include "common/map_commands/live_map_save.hpp"

#include <algorithm>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/commander/commander.hpp"
#include "common/map_file/atomic_file.hpp"
#include "common/map_file/saved_map.hpp"
#include "common/service/random_id.hpp"

namespace rds::map_commands {
namespace fs = std::filesystem;
namespace {

using Answer = tl::expected<std::string, std::string>;
using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kStatusTime{300};
constexpr std::chrono::seconds kCommandTime{90};  // longer than a service takes to give up

std::string random_id() {
  return fmt::format("{:016x}", service::random_id());
}

/// "rds-loop-closer" of the part "loop_closer".
std::string service_of(const std::string& part) {
  std::string service = "rds-" + part;
  std::ranges::replace(service, '_', '-');
  return service;
}

/// The parts of the map whose services answer before the deadline; all three end the wait.
std::vector<std::string> wait_for_parts(commander::Commander& commander, Clock::time_point deadline,
                                        const std::stop_token& stop) {
  std::vector<std::string> there;
  while (there.size() < map_file::kParts.size() && Clock::now() < deadline && !stop.stop_requested()) {
    there.clear();
    const auto answers = commander.ask_status(5, stop, kStatusTime);
    for (const std::string& part : map_file::kParts)
      if (answers.contains(service_of(part))) there.push_back(part);
  }
  return there;
}

tl::expected<std::vector<std::string>, std::string> find_parts(commander::Commander& commander,
                                                               std::chrono::duration<double> timeout,
                                                               const std::stop_token& stop) {
  auto parts =
      wait_for_parts(commander, Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout), stop);
  for (const std::string& needed : {map_file::kTracker, map_file::kMapper})
    if (std::ranges::find(parts, needed) == parts.end())
      return tl::unexpected(fmt::format("{} does not answer, expected it to be running", service_of(needed)));
  return parts;
}

Answer ask(commander::Commander& commander, const std::string& service, const std::string& verb,
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
  commander::Commander commander(participant);
  auto parts = find_parts(commander, timeout, stop);
  if (!parts) return tl::unexpected(parts.error());
  const nlohmann::json order{{"name", name}, {"id", random_id()}, {"parts", *parts}};
  LiveSave saved;
  bool published = false;
  std::ranges::reverse(*parts);  // so the loop closer's has no keyframe that the tracker's does not know
  for (const std::string& part : *parts) {
    const std::string service = service_of(part);
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
  commander::Commander commander(participant);
  const auto parts = find_parts(commander, timeout, stop);
  if (!parts) return tl::unexpected(parts.error());
  std::map<std::string, std::string> answers;
  for (const std::string& part : *parts) {
    const std::string service = service_of(part);
    const Answer answer = ask(commander, service, "load", name, stop);
    if (!answer) return tl::unexpected(answer.error());
    answers[service] = *answer;
  }
  return answers;
}

}  // namespace rds::map_commands
