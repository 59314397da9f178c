// SPDX-License-Identifier: Apache-2.0
// map_follower VENDOR DOMAIN topics|transfer PEERS: keeps a copy of the map, from its topics as a program of
// somebody else would, or as ours do, and prints at each change the time of the steady clock [s] and the
// revision. Ends when it is killed.
#include "services/mapper/reader/map_follower.hpp"

#include <chrono>
#include <cstdint>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "common/bus/peer_addresses.hpp"
#include "tests/support/map_reader.hpp"

namespace {

using namespace std::chrono_literals;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Revision>
[[noreturn]] void follow(const Revision& revision_now) {
  fmt::print("{:.4f} 0\n", now_s());
  for (std::uint64_t last = 0;; std::this_thread::sleep_for(10ms)) {
    const std::uint64_t revision = revision_now();
    if (revision == last) continue;
    last = revision;
    fmt::print("{:.4f} {}\n", now_s(), revision);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const auto bus = rds::bus::Participant::create({.vendor = rds::bus::vendor_from_name(argv[1]),
                                                  .domain = std::stoi(argv[2]),
                                                  .node_name = "map_follower",
                                                  .peers = rds::bus::peer_addresses(argv[4])});
  if (argv[3] == std::string("topics")) {
    rds::test::MapReader reader(*bus);
    follow([&] { return reader.revision(); });
  }
  rds::service::Diagnostics diagnostics;
  rds::service::ServiceContext context{"map_follower", *bus, diagnostics};
  const rds::mapper::MapFollower follower(context);
  follow([&] { return follower.map().place().revision; });
}
