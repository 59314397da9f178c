// SPDX-License-Identifier: Apache-2.0
// `rds simulate` as a program of its own: simulate_scene --out DIR [options].
#include "tools/rds/cli/commands.hpp"

int main(int argc, char** argv) {
  CLI::App app{"Renders a recording"};
  rds::tools::add_simulate_command(app);
  app.require_subcommand(1);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : (e.get_name() == "RuntimeError" ? e.get_exit_code() : 2);
  }
  return 0;
}
