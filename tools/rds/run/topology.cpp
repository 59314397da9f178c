// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/topology.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace rds::run {
namespace {

struct Topic {
  std::string name;
  std::set<std::string> writers;
  std::set<std::string> readers;
};

const std::vector<Topic>& topics() {
  static const std::vector<Topic> kTopics{
      {"camera/color/image_raw", {kPlayer}, {kTracker}},
      {"camera/color/camera_info", {kPlayer}, {kTracker, kTransformer}},
      {"camera/aligned_depth_to_color/image_raw", {kPlayer}, {kTracker}},
      {"rds/tracking_state", {kTracker}, {kPlayer}},
      {"rds/predicted_boxes", {kTracker}, {kPlayer}},
      {"rds/features", {kTracker}, {kPlayer}},
      {"rds/keyframe/images", {kTracker}, {kDetector, kMapper}},
      {"rds/keyframe/features", {kTracker}, {kLoopCloser}},
      {"rds/keyframe/poses", {kTracker, kLoopCloser}, {kPlayer, kTracker, kTransformer, kMapper}},
      {"rds/detections", {kDetector}, {kPlayer, kTransformer}},
      {"rds/boxes", {kTransformer}, {kTracker, kMapper}},
      {"rds/map/info", {kMapper}, {kPlayer}},
      {"rds/command", {kPlayer}, {kTracker, kDetector, kTransformer, kMapper, kLoopCloser}},
      {"rds/command_result", {kTracker, kDetector, kTransformer, kMapper, kLoopCloser}, {kPlayer}},
  };
  return kTopics;
}

std::size_t count_running(const std::set<std::string>& processes, const std::set<std::string>& running) {
  return static_cast<std::size_t>(
      std::ranges::count_if(processes, [&](const std::string& name) { return running.contains(name); }));
}

}  // namespace

std::string part_of(const std::string& service) {
  std::string part = service.substr(std::string("rds-").size());
  std::ranges::replace(part, '-', '_');
  return part;
}

std::vector<std::string> missing_links(const std::set<std::string>& running,
                                       const std::map<std::string, std::vector<Endpoint>>& endpoints,
                                       bool localize_only) {
  std::vector<std::string> missing;
  const auto check = [&](const std::string& process, const Topic& topic, bool publisher) {
    const auto reported = endpoints.find(process);
    if (!running.contains(process)) return;
    if (reported == endpoints.end()) {
      if (std::ranges::find(missing, process + " does not answer") == missing.end())
        missing.push_back(process + " does not answer");
      return;
    }
    const std::size_t expected = count_running(publisher ? topic.readers : topic.writers, running);
    const auto endpoint = std::ranges::find_if(reported->second, [&](const Endpoint& e) {
      return e.topic == topic.name && e.publisher == publisher;
    });
    const int matched = endpoint == reported->second.end() ? 0 : endpoint->matched;
    if (matched < static_cast<int>(expected))
      missing.push_back(fmt::format("{} {} {}: {} of {} {}", process, publisher ? "writes" : "reads",
                                    topic.name, matched, expected, publisher ? "readers" : "writers"));
  };
  static const std::set<std::string> kMapped{"rds/keyframe/images", "rds/keyframe/features", "rds/boxes"};
  for (Topic topic : topics()) {
    if (localize_only && kMapped.contains(topic.name))
      std::erase_if(topic.readers, [](const std::string& r) { return r == kMapper || r == kLoopCloser; });
    for (const std::string& writer : topic.writers) check(writer, topic, true);
    for (const std::string& reader : topic.readers) check(reader, topic, false);
  }
  return missing;
}

}  // namespace rds::run
