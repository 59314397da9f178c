// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/bus/zenoh/zenoh_router.hpp"
#include "common/concurrency/mailbox.hpp"
#include "tools/rds/cli/commands.hpp"
#include "tools/rds/cli/interrupt.hpp"
#include "tools/rds/cli/secure_options.hpp"

namespace rds::tools {
namespace {

struct RouterOptions {
  std::vector<std::string> listen{"[::]:7447"};
  std::vector<std::string> connect;
  SecureOptions secure{.identities = {"router"}};
};

void route(const RouterOptions& options) {
  const bus::ZenohRouterOptions router{options.listen, options.connect, options.secure.credentials()};
  const Interrupt interrupt;
  const bus::ZenohRouter routing(router);
  fmt::print(stderr, "rds router: listens on {}\n", fmt::join(options.listen, ", "));
  concurrency::Mailbox until_stopped;
  until_stopped.wait(interrupt.token(), [] { return false; });
}

}  // namespace

void add_router_command(CLI::App& rds) {
  auto* command =
      rds.add_subcommand("router", "a router of Zenoh, for machines that do not reach each other");
  auto options = std::make_shared<RouterOptions>();
  command
      ->add_option("--listen", options->listen,
                   "Where it is dialled: addresses with a port, or endpoints of Zenoh")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--connect", options->connect, "Other routers: robot,10.0.0.7:7448,tcp/nas:7448")
      ->delimiter(',')
      ->envname("RDS_ROUTERS");
  add_secure_options(*command, options->secure);
  command->callback([options] { route(*options); });
}

}  // namespace rds::tools
