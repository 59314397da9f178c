// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/far/terms.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "tools/rds/topology/topology.hpp"
#include "tools/rds/run/output/result_file.hpp"
#include "tools/rds/run/services/service_commands.hpp"

namespace rds::run {
namespace {

std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

bool has_map_part(const std::set<std::string>& services) {
  return services.contains(kMapper) || services.contains(kLoopCloser);
}

/// @throws std::runtime_error if this machine's hosts file has not all of them here.
void check_services(const std::set<std::string>& services, const hosts::Machine& machine) {
  if (!std::ranges::includes(machine.services, services))
    throw std::runtime_error(fmt::format("the hosts file of {} has {} there, and not {}", machine.name,
                                         fmt::join(machine.services, ", "), fmt::join(services, ", ")));
}

void check_map(bool expected, const std::set<std::string>& services, const RunOptions& options) {
  if (has_map_part(services) && expected == options.map.empty())
    throw std::runtime_error(expected ? "--map: expected here too, as the run goes on in a saved map"
                                      : "--map: not expected here, as the run begins a new map");
}

}  // namespace

std::string terms_of(const RunOptions& options, const hosts::HostsFile& hosts, const std::string& machine,
                     const std::string& run) {
  std::set<std::string> services = services_of(options);
  std::erase_if(services, [&](const auto& s) { return !hosts.machine(machine).services.contains(s); });
  return nlohmann::json{{"run", run},
                        {"services", services},
                        {"rate", options.rate},
                        {"dynamics", options.dynamics},
                        {"localize_only", options.localize_only},
                        {"map", !options.map.empty()},
                        {"network", options.model},
                        {"settings", options.config.empty() ? "" : contents(options.config)}}
      .dump();
}

void accept_terms(const std::string& terms, const hosts::Machine& machine,
                         const std::filesystem::path& folder, RunOptions& options) {
  const auto json = nlohmann::json::parse(terms, nullptr, false);
  try {
    options.here->services = json.at("services").get<std::set<std::string>>();
    check_services(options.here->services, machine);
    check_map(json.at("map").get<bool>(), options.here->services, options);
    options.rate = json.at("rate").get<double>();
    options.dynamics = json.at("dynamics").get<bool>();
    options.localize_only = json.at("localize_only").get<bool>();
    options.model = json.at("network").get<std::string>();
    options.config = folder / "settings.yaml";
    write_result(options.config, json.at("settings").get<std::string>());
  } catch (const nlohmann::json::exception&) {
    throw std::runtime_error("not the terms of a run: another version of rds?");
  }
}

void check_placement(const RunOptions& options, const hosts::HostsFile& hosts, const hosts::Machine& here) {
  const std::set<std::string> placed = hosts.services();
  for (const std::string& service : services_of(options))
    if (!placed.contains(service))
      throw std::runtime_error(fmt::format("the hosts file: expected a machine for {}", part_of(service)));
  if (here.services.contains(kDetector)) return;
  for (const auto& [option, file] : {std::pair{"--detections", options.detections},
                                     std::pair{"--model-dir", std::filesystem::path(options.model_dir)}})
    if (!file.empty())
      throw std::runtime_error(
          fmt::format("{}: expected on the command line of the detector's machine, not of {}", option,
                      here.name));
}

}  // namespace rds::run
