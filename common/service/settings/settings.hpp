// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>
#include <yaml-cpp/yaml.h>

#include "common/config/config_reader.hpp"

namespace rds::service {

class Service;
struct ServiceContext;

/// Makes a service of a configuration that was read before.
using ServiceFactory = std::function<std::unique_ptr<Service>(ServiceContext&)>;

/// What a service makes of its configuration.
struct Configured {
  ServiceFactory make;
  int nice = 0;                         // of its process
  std::vector<std::string> live = {};   // names in full of the settings that may change while it runs
  std::function<void(Service&)> apply;  // has a running service of this kind take those over, on its worker
};

/// The settings of a service: read at the start; those that may change while it runs are read again then, by
/// the same reader, so with the same bounds.
class Settings {
 public:
  /// @throws config::ConfigError naming all that is wrong.
  using Read = std::function<Configured(config::ConfigReader&)>;
  using Values = std::map<std::string, YAML::Node>;  // by names in full: "grid.min_height_m"

  /// Reads the settings.
  /// @param file  empty: there is none. @param parameters  a map, in which values win over the file's.
  /// @throws config::ConfigError naming all that is wrong.
  Settings(const std::string& file, const YAML::Node& parameters, Read read);

  [[nodiscard]] const Configured& configured() const { return configured_; }
  /// All that was set, as one map.
  [[nodiscard]] const YAML::Node& given() const { return given_; }

  /// The command `set`: changes settings of the running service, all of them or none, on its worker.
  /// @param changes  a YAML map of names in full and values. @return or why nothing has changed.
  tl::expected<void, std::string> set(const std::string& changes, Service& service);
  /// @param tell  is told, on the worker, what was changed.
  void when_set(std::function<void(const Values&)> tell) { tell_ = std::move(tell); }

 private:
  Read read_;
  YAML::Node given_;
  Configured configured_;
  std::function<void(const Values&)> tell_;
};

}  // namespace rds::service
