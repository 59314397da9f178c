// SPDX-License-Identifier: Apache-2.0
#include "common/service/settings/settings.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include "common/config/overrides.hpp"
#include "common/service/process/printable.hpp"
#include "common/service/ros/parameters.hpp"

namespace rds::service {
namespace {

/// @throws std::invalid_argument if the text is no map of names and values.
Settings::Values values_of(const std::string& changes) {
  const YAML::Node map = YAML::Load(changes);
  if (!map.IsMap()) throw std::invalid_argument("set: expected a map of names and values");
  Settings::Values values;
  for (const auto& entry : map) values.emplace(entry.first.as<std::string>(), entry.second);
  return values;
}

}  // namespace

Settings::Settings(const std::string& file, const YAML::Node& parameters, Read read)
    : read_(std::move(read)) {
  auto reader = config::from_file_with(file, parameters, "ROS parameters");
  configured_ = read_(reader);
  given_ = config::merged(file, parameters);
}

tl::expected<void, std::string> Settings::set(const std::string& changes, Service& service) {
  const Values values = values_of(changes);
  YAML::Node wanted = YAML::Clone(given_);
  for (const auto& [name, value] : values) {
    if (std::ranges::find(configured_.live, name) == configured_.live.end())
      return tl::unexpected(fmt::format("'{}' does not change while the service runs, expected one of: {}",
                                        printable(name), fmt::join(configured_.live, ", ")));
    set_parameter(name, value, wanted);
  }
  config::ConfigReader reader(wanted, "set");
  try {
    configured_ = read_(reader);
  } catch (const config::ConfigError& e) {
    return tl::unexpected<std::string>(e.what());
  }
  given_ = wanted;
  configured_.apply(service);
  for (const auto& [name, value] : values) spdlog::info("{} is {} now", name, printable(YAML::Dump(value)));
  if (tell_) tell_(values);
  return {};
}

}  // namespace rds::service
