// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/bus/versions/vendor_versions.hpp"
#include "common/bus/zenoh/links/link_policy.hpp"
#include "common/command_line/document_option.hpp"
#include "tools/rds/cli/commands.hpp"

int main(int argc, char** argv) {
  constexpr int kBadUsage = 2;
  CLI::App rds{"RDS-SLAM: real-time semantic mapping of places where people walk about", "rds"};
  rds.set_version_flag("--version", [] { return RDS_VERSION "\n" + rds::bus::vendor_versions(); });
  rds::command_line::add_document_option(rds, RDS_VERSION);
  rds.require_subcommand(1);
  rds::bus::set_link_policy(
      {.tell = [](const std::string& sentence) { fmt::print(stderr, "rds: {}\n", sentence); },
       .reach_within = std::chrono::seconds(5)});
  rds::run::add_run_command(rds);
  rds::play::add_play_command(rds);
  rds::record::add_record_command(rds);
  rds::tools::add_convert_command(rds);
  rds::tools::add_eval_command(rds);
  rds::tools::add_hosts_command(rds);
  rds::tools::add_map_command(rds);
  rds::tools::add_topic_command(rds);
  rds::tools::add_status_command(rds);
  rds::tools::add_models_command(rds);
  rds::doctor::add_doctor_command(rds);
  rds::tools::add_simulate_command(rds);
  rds::secure::add_secure_command(rds);
  rds::tools::add_router_command(rds);
  try {
    rds.parse(argc, argv);
  } catch (const CLI::RuntimeError& e) {
    return e.get_exit_code();
  } catch (const CLI::ParseError& e) {
    return rds.exit(e) == 0 ? 0 : kBadUsage;
  } catch (const std::exception& e) {
    fmt::print(stderr, "rds: {}\n", e.what());
    return kBadUsage;
  }
  return 0;
}
