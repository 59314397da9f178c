// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/topology/topology.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/topics/table.hpp"
#include "common/topics/topics.hpp"

namespace rds::run {
namespace {

/// A process and the name it reports under.
struct Member {
  topics::Process process;
  const std::string& name;
};

const std::array<Member, 6>& members() {
  static const std::array<Member, 6> kMembers{{{topics::kPlayer, kPlayer},
                                               {topics::kTracker, kTracker},
                                               {topics::kDetector, kDetector},
                                               {topics::kTransformer, kTransformer},
                                               {topics::kMapper, kMapper},
                                               {topics::kLoopCloser, kLoopCloser}}};
  return kMembers;
}

/// Names of processes that write a topic, or read it.
struct Link {
  std::string topic;
  std::set<std::string> writers;
  std::set<std::string> readers;
};

std::vector<Link> links() {
  std::vector<Link> links;
  for (const topics::Row& row : topics::table()) {
    if (row.name == topics::kServiceStatus.name) continue;        // said every second: nothing is lost
    if (row.name == topics::kTransforms.name) continue;           // said with every frame, for others
    if (row.name == topics::kStaticTransforms.name) continue;     // kept for who comes late
    if (row.name.starts_with(topics::kTransferPrefix)) continue;  // for other machines
    Link& link = links.emplace_back(row.name);
    for (const auto& [process, name] : members()) {
      if (row.is_written_by(process)) link.writers.insert(name);
      if (row.is_read_by(process)) link.readers.insert(name);
    }
  }
  return links;
}

std::size_t count_running(const std::set<std::string>& processes, const std::set<std::string>& running) {
  return static_cast<std::size_t>(
      std::ranges::count_if(processes, [&](const std::string& name) { return running.contains(name); }));
}

}  // namespace

std::string service_of(const std::string& name) {
  std::string service = name.starts_with("rds-") ? name : "rds-" + name;
  std::ranges::replace(service, '_', '-');
  const auto is_it = [&](const Member& member) { return member.name == service; };
  return std::ranges::any_of(members(), is_it) ? service : "";
}

std::string part_of(const std::string& service) {
  std::string part = service.substr(std::string("rds-").size());
  std::ranges::replace(part, '-', '_');
  return part;
}

Endpoints endpoints_of(const bus::Participant& player, const std::map<std::string, std::string>& statuses) {
  Endpoints endpoints;
  for (const auto& e : player.statistics()) endpoints[kPlayer].push_back({e.topic, e.publisher, e.matched});
  for (const auto& [service, text] : statuses) {
    const auto status = nlohmann::json::parse(text, nullptr, false);
    if (!status.is_object() || !status.contains("endpoints")) continue;
    for (const auto& e : status["endpoints"])
      endpoints[service].push_back(
          {e.value("topic", ""), e.value("publisher", false), e.value("matched", 0)});
  }
  return endpoints;
}

std::vector<std::string> missing_links(const std::set<std::string>& running, const Endpoints& endpoints,
                                       bool localize_only, const std::set<std::string>& far) {
  std::vector<std::string> missing;
  const auto check = [&](const std::string& process, const Link& link, bool publisher) {
    const auto reported = endpoints.find(process);
    if (!running.contains(process)) return;
    if (reported == endpoints.end()) {
      if (std::ranges::find(missing, process + " does not answer") == missing.end())
        missing.push_back(process + " does not answer");
      return;
    }
    const std::size_t expected = count_running(publisher ? link.readers : link.writers, running);
    const auto endpoint = std::ranges::find_if(reported->second, [&](const Endpoint& e) {
      return e.topic == link.topic && e.publisher == publisher;
    });
    const int matched = endpoint == reported->second.end() ? 0 : endpoint->matched;
    if (matched < static_cast<int>(expected))
      missing.push_back(fmt::format("{} {} {}: {} of {} {}", process, publisher ? "writes" : "reads",
                                    link.topic, matched, expected, publisher ? "readers" : "writers"));
  };
  const auto is_used = [&](const std::string& topic) {  // by a player that was told to
    const auto player = endpoints.find(kPlayer);
    return player != endpoints.end() &&
           std::ranges::any_of(player->second, [&](const Endpoint& e) { return e.topic == topic; });
  };
  static const std::set<std::string> kMapped{topics::kKeyframeImages.name, topics::kBoxes.name};
  static const std::set<std::string> kTransferred{topics::kKeyframeImages.name,
                                                  topics::kKeyframeFeatures.name};
  static const std::set<std::string> kPerhapsPlayed{topics::kRobotOdometry.name, topics::kImu.name};
  for (Link& link : links()) {
    if (kPerhapsPlayed.contains(link.topic) && !is_used(link.topic)) continue;
    if (localize_only && kMapped.contains(link.topic)) link.readers.erase(kMapper);
    if (kTransferred.contains(link.topic))
      std::erase_if(link.readers, [&](const std::string& r) { return far.contains(r); });
    for (const std::string& writer : link.writers) check(writer, link, true);
    for (const std::string& reader : link.readers) check(reader, link, false);
  }
  return missing;
}

}  // namespace rds::run
