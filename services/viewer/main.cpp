// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <CLI/CLI.hpp>

#include "common/service/run_service.hpp"
#include "services/viewer/viewer_service.hpp"

namespace {

/// Options that set settings, by the same names.
void add_options(CLI::App& app, YAML::Node& settings) {
  const auto sets = [settings](const std::string& name) {
    return [settings, name](const std::string& value) mutable { settings[name] = value; };
  };
  app.add_option_function<std::string>("--listen", sets("listen"),
                                       "ADDRESS:PORT or PORT of the page (default: 127.0.0.1:8080)");
  app.add_option_function<std::string>("--token-file", sets("token_file"),
                                       "File with the token that others than this machine need");
  app.add_flag_callback(
      "--allow-commands", [settings]() mutable { settings["allow_commands"] = true; },
      "Pages may pause, resume, reset and save the map");
}

rds::service::Configured read_settings(rds::config::ConfigReader& reader) {
  rds::viewer::ViewerServiceConfig config;
  read(reader, config);
  reader.finish();
  return rds::service::configured<rds::viewer::ViewerService>(config, access_token(config));
}

}  // namespace

int main(int argc, char** argv) {
  return rds::service::run_service("rds-viewer", argc, argv, rds::service::kShippedSettings, read_settings,
                                   add_options);
}
