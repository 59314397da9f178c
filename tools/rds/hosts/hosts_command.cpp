// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "tools/rds/cli/commands.hpp"
#include "tools/rds/cli/exit.hpp"
#include "tools/rds/hosts/compose_files.hpp"
#include "tools/rds/run/output/result_file.hpp"

namespace rds::tools {
namespace {

struct ComposeOptions {
  std::filesystem::path file;
  std::filesystem::path out;
};

void write_compose_files(const ComposeOptions& options) try {
  const hosts::HostsFile hosts = hosts::read_hosts_file(options.file);
  std::filesystem::create_directories(options.out);
  for (const hosts::Machine& machine : hosts.machines) {
    const auto file = options.out / (machine.name + ".yaml");
    run::write_result(file, hosts::compose_override(hosts, machine.name, options.file.filename().string()));
    fmt::print("{}\n", file.string());
  }
} catch (const std::exception& e) {
  exit_with(kExitBadInput, e.what());
}

}  // namespace

void add_hosts_command(CLI::App& rds) {
  auto* command = rds.add_subcommand("hosts", "services on several machines, from a hosts file");
  command->require_subcommand(1);
  const auto options = std::make_shared<ComposeOptions>();
  auto* compose = command->add_subcommand("compose", "write a Compose override for each machine");
  compose->add_option("file", options->file, "hosts file")->required();
  compose->add_option("--out", options->out, "folder for the overrides")->required();
  compose->callback([options] { write_compose_files(*options); });
}

}  // namespace rds::tools
