// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/topic/topic_report.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "tools/evaluation/statistics.hpp"

namespace rds::tools {
namespace {
using evaluation::percentile;
constexpr double kKilo = 1000;

double span_s(std::span<const Arrival> arrivals) {
  return std::chrono::duration<double>(arrivals.back().time - arrivals.front().time).count();
}

std::string bytes_text(double bytes) {
  if (bytes >= kKilo * kKilo) return fmt::format("{:.2f} MB", bytes / kKilo / kKilo);
  if (bytes >= kKilo) return fmt::format("{:.2f} kB", bytes / kKilo);
  return fmt::format("{:.0f} B", bytes);
}

}  // namespace

std::string ros_type_name(const std::string& dds_name) {
  const std::string middle = "::msg::dds_::";
  const std::size_t at = dds_name.find(middle);
  if (at == std::string::npos || !dds_name.ends_with('_')) return dds_name;
  const std::size_t name = at + middle.size();
  return dds_name.substr(0, at) + "/msg/" + dds_name.substr(name, dds_name.size() - name - 1);
}

std::vector<TopicSummary> summarise(const std::vector<bus::DiscoveredEndpoint>& endpoints) {
  std::map<std::pair<std::string, std::string>, TopicSummary> topics;
  for (const auto& endpoint : endpoints) {
    auto& summary = topics[{endpoint.topic, endpoint.type}];
    summary.topic = endpoint.topic;
    summary.type = ros_type_name(endpoint.type);
    ++(endpoint.publisher ? summary.publishers : summary.subscribers);
  }
  std::vector<TopicSummary> result;
  result.reserve(topics.size());
  for (auto& [key, summary] : topics) result.push_back(std::move(summary));
  return result;
}

nlohmann::ordered_json shortened(const nlohmann::ordered_json& value, std::size_t longest) {
  if (!value.is_structured()) return value;
  auto result = value.is_array() ? nlohmann::ordered_json::array() : nlohmann::ordered_json::object();
  if (value.is_object()) {
    for (const auto& [name, member] : value.items()) result[name] = shortened(member, longest);
    return result;
  }
  for (std::size_t i = 0; i < std::min(longest, value.size()); ++i)
    result.push_back(shortened(value[i], longest));
  if (value.size() > longest) result.push_back(fmt::format("… {} values", value.size()));
  return result;
}

std::string rate_report(std::span<const Arrival> arrivals) {
  if (arrivals.size() < 2) return fmt::format("{} messages, a rate needs two", arrivals.size());
  std::vector<double> intervals_ms;
  for (std::size_t i = 1; i < arrivals.size(); ++i)
    intervals_ms.push_back(kKilo *
                           std::chrono::duration<double>(arrivals[i].time - arrivals[i - 1].time).count());
  const double rate = static_cast<double>(arrivals.size() - 1) / span_s(arrivals);
  return fmt::format("{:.2f} Hz, {} messages, interval ms: min {:.2f} median {:.2f} p99 {:.2f} max {:.2f}",
                     rate, arrivals.size(), percentile(intervals_ms, 0), percentile(intervals_ms, 50),
                     percentile(intervals_ms, 99), percentile(intervals_ms, 100));
}

std::string bandwidth_report(std::span<const Arrival> arrivals) {
  if (arrivals.size() < 2) return fmt::format("{} messages, a bandwidth needs two", arrivals.size());
  std::vector<double> sizes;
  for (const auto& arrival : arrivals) sizes.push_back(static_cast<double>(arrival.bytes));
  // The first message's bytes belong to the time before it came.
  const double total = std::accumulate(sizes.begin() + 1, sizes.end(), 0.0);
  return fmt::format("{}/s, {} messages, size: min {} median {} max {}", bytes_text(total / span_s(arrivals)),
                     arrivals.size(), bytes_text(percentile(sizes, 0)), bytes_text(percentile(sizes, 50)),
                     bytes_text(percentile(sizes, 100)));
}

}  // namespace rds::tools
