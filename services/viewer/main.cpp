// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <CLI/CLI.hpp>

#include "common/service/run_service.hpp"
#include "services/viewer/listen_address.hpp"
#include "services/viewer/viewer_service.hpp"

namespace {

/// What the command line says goes before the settings' file.
struct ViewerOptions {
  std::string listen;
  std::string token_file;
  bool allow_commands = false;
};

}  // namespace

int main(int argc, char** argv) {
  using namespace rds;
  ViewerOptions options;
  const auto add_options = [&](CLI::App& app) {
    app.add_option("--listen", options.listen, "ADDRESS:PORT or PORT of the page (default: 127.0.0.1:8080)");
    app.add_option("--token-file", options.token_file,
                   "File with the token that others than this machine need");
    app.add_flag("--allow-commands", options.allow_commands,
                 "Pages may pause, resume, reset and save the map");
  };
  const auto read_config = [&](config::ConfigReader& reader) -> service::ServiceFactory {
    viewer::ViewerServiceConfig config;
    read(reader, config);
    if (!options.listen.empty()) config.listen = options.listen;
    if (const auto listen = viewer::parse_listen_address(config.listen); !listen && !options.listen.empty())
      reader.violation("--listen", options.listen, "expected " + listen.error());
    if (!options.token_file.empty()) config.token_file = options.token_file;
    config.allow_commands = config.allow_commands || options.allow_commands;
    reader.finish();
    const std::string token = access_token(config);
    service::give_way(config.nice);
    return [config, token](service::ServiceContext& context) {
      return std::make_unique<viewer::ViewerService>(context, config, token);
    };
  };
  return service::run_service("rds-viewer", argc, argv, "", read_config, add_options);
}
