// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <iterator>
#include <memory>
#include <string>

#include "common/service/service.hpp"
#include "common/service/settings/settings.hpp"

namespace CLI {
class App;
}

namespace rds::service {

/// The YAML file of a service, with all of its settings: a part of its program by rds_shipped_settings().
extern const char* const kShippedSettings;

/// The whole main() of a service: command line, configuration, log, signals, commands, diagnostics, worker.
/// @param shipped_settings  YAML of every setting, its default and its meaning, for ROS 2's parameter
/// services; empty: there are none.
/// @param read  reads the configuration. @throws config::ConfigError naming all that is wrong in it.
/// @param add_options  adds options of the service's own to the command line, before it is read; what they
/// set in the map of settings goes before all else that sets them.
/// @return 0 after a clean stop, 1 after a fault, 2 for bad usage or configuration.
int run_service(const std::string& name, int argc, char** argv, const std::string& shipped_settings,
                const Settings::Read& read,
                const std::function<void(CLI::App&, YAML::Node& settings)>& add_options = {});

/// What a service is made of a configuration by. Settings that may change while it runs are those that it
/// names as `kLiveSettings`; its `reconfigure(config)` takes them over, on its worker.
/// @param more  what its constructor takes besides.
template <class ServiceType, class Config, class... More>
Configured configured(const Config& config, const More&... more) {
  Configured made{.make = [=](ServiceContext& context) -> std::unique_ptr<Service> {
                    return std::make_unique<ServiceType>(context, config, more...);
                  },
                  .nice = config.nice,
                  .apply = [](Service&) {}};
  if constexpr (requires { ServiceType::kLiveSettings; }) {
    made.live.assign(std::begin(ServiceType::kLiveSettings), std::end(ServiceType::kLiveSettings));
    made.apply = [config](Service& service) { dynamic_cast<ServiceType&>(service).reconfigure(config); };
  }
  return made;
}

/// run_service() for a service whose configuration is read by `read(ConfigReader&, Config&)`; the process
/// gives way to others by its `nice`.
template <class ServiceType, class Config>
int run_service(const std::string& name, int argc, char** argv, const std::string& shipped_settings) {
  return run_service(name, argc, argv, shipped_settings, [](config::ConfigReader& reader) {
    Config config;
    read(reader, config);
    reader.finish();
    return configured<ServiceType>(config);
  });
}

}  // namespace rds::service
