// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/service/service.hpp"

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
/// @param add_options  adds options of the service's own to the command line, before it is read.
/// @return 0 after a clean stop, 1 after a fault, 2 for bad usage or configuration.
int run_service(const std::string& name, int argc, char** argv, const std::string& shipped_settings,
                const std::function<ServiceFactory(config::ConfigReader&)>& read,
                const std::function<void(CLI::App&)>& add_options = {});

/// Lowers the priority of the process, and lets its threads share freed memory if that is above 0; says so
/// where the priority is not allowed. Call before there are threads.
void give_way(int nice);

/// run_service() for a service whose configuration is read by `read(ConfigReader&, Config&)`; the process
/// gives way to others by its `nice`.
template <class ServiceType, class Config>
int run_service(const std::string& name, int argc, char** argv, const std::string& shipped_settings) {
  return run_service(name, argc, argv, shipped_settings, [](config::ConfigReader& reader) -> ServiceFactory {
    Config config;
    read(reader, config);
    reader.finish();
    give_way(config.nice);
    return [config](ServiceContext& context) { return std::make_unique<ServiceType>(context, config); };
  });
}

}  // namespace rds::service
