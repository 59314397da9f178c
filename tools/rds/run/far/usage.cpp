// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/far/usage.hpp"

#include <stdexcept>

#include <nlohmann/json.hpp>

namespace rds::run {

std::string usage_to_json(const std::map<std::string, ServiceUsage>& usage) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [service, used] : usage)
    json[service] = {{"cpu_s", used.cpu_s},
                     {"peak_bytes", used.peak_bytes},
                     {"restarts", used.restarts},
                     {"failures", used.failures}};
  return json.dump();
}

std::map<std::string, ServiceUsage> usage_from_json(const std::string& text) {
  std::map<std::string, ServiceUsage> usage;
  try {
    const auto all = nlohmann::json::parse(text);
    for (const auto& [service, json] : all.items())
      usage[service] = {json.at("cpu_s").get<double>(), json.at("peak_bytes").get<std::uint64_t>(),
                        json.at("restarts").get<int>(), json.at("failures").get<std::vector<int>>()};
  } catch (const nlohmann::json::exception&) {
    throw std::runtime_error("not what services used: another version of rds?");
  }
  return usage;
}

}  // namespace rds::run
