// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/topic/topic_table.hpp"

#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "common/topics/table.hpp"

namespace rds::tools {
namespace {

constexpr std::array kNames{
    std::pair(topics::kTracker, "tracker"),          std::pair(topics::kDetector, "detector"),
    std::pair(topics::kTransformer, "transformer"),  std::pair(topics::kMapper, "mapper"),
    std::pair(topics::kLoopCloser, "loop closer"),   std::pair(topics::kViewer, "viewer"),
    std::pair(topics::kPlayer, "rds run, rds play"), std::pair(topics::kTool, "other rds"),
    std::pair(topics::kFarRun, "rds run elsewhere")};

/// "tracker, mapper"; "–" for nobody of this project.
std::string names_of(std::initializer_list<topics::Endpoint> endpoints) {
  std::vector<std::string> names;
  for (const auto& [process, name] : kNames)
    for (const topics::Endpoint& endpoint : endpoints)
      if (topics::contains(endpoint.processes, process)) names.emplace_back(name);
  return names.empty() ? "–" : fmt::format("{}", fmt::join(names, ", "));
}

/// Of the endpoints' first.
std::string qos_of(const topics::Row& row) {
  const auto& endpoints = row.writers.size() > 0 ? row.writers : row.readers;
  const bus::Qos& qos = endpoints.begin()->qos;
  return fmt::format("{}{}, {}", qos.reliable ? "reliable" : "best effort",
                     qos.transient_local ? ", transient local" : "",
                     qos.depth == 0 ? "keep all" : fmt::format("keep last {}", qos.depth));
}

}  // namespace

std::string topic_table() {
  std::string text = "| topic | type | QoS | written by | read by |\n|---|---|---|---|---|\n";
  for (const topics::Row& row : topics::table())
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", row.address(), row.type, qos_of(row),
                        names_of(row.writers), names_of(row.readers));
  return text;
}

}  // namespace rds::tools
