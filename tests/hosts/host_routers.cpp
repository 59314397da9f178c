// SPDX-License-Identifier: Apache-2.0
#include "tests/hosts/host_routers.hpp"

#include <stdexcept>

#include "tests/integration/run_support.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;

constexpr auto kLimit = 10s;

std::unique_ptr<Process> router(const HostNetwork& network, const std::string& host,
                                const std::vector<std::string>& options = {}) {
  std::vector<std::string> command{rds(), "router", "--listen", "0.0.0.0:7447"};
  command.insert(command.end(), options.begin(), options.end());
  return std::make_unique<Process>(network.on(host, command));
}

void wait_for(Process& router) {
  if (!router.wait_for_output("listens", kLimit)) throw std::runtime_error(router.standard_error());
}

}  // namespace

HostRouters::HostRouters(HostNetwork& network, Way way, const std::filesystem::path& out) : network_(network) {
  if (way == Way::kDirect) return;
  network.hide("A");
  start();
  wait_for(*on_r_);
  if (way == Way::kRouters) {
    on_a_ = router(network, "A", {"--connect", network.address(kRouterHost)});
    wait_for(*on_a_);
  }
  client_ = out / "client.json5";
  write_text(client_, R"({mode: "client", connect: {endpoints: ["tcp/)" +
                          (on_a_ ? "127.0.0.1" : network.address(kRouterHost)) +
                          R"(:7447"]}, listen: {endpoints: []}})");
}

void HostRouters::start() {
  on_r_ = router(network_, kRouterHost);
}

std::string HostRouters::client_settings(const std::string& host) const {
  return host == "A" ? client_.string() : "";
}

}  // namespace rds::test
