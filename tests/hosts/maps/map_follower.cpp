// SPDX-License-Identifier: Apache-2.0
// map_follower VENDOR DOMAIN: keeps a copy of the map as a program of somebody else does, from its topics, and
// prints at each change the time of the steady clock [s] and the revision. Ends when it is killed.
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "tests/support/map_reader.hpp"

namespace {

using namespace std::chrono_literals;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Reader>
[[noreturn]] void follow(Reader& reader) {
  fmt::print("{:.4f} 0\n", now_s());
  for (std::uint64_t last = 0;; std::this_thread::sleep_for(10ms)) {
    const std::uint64_t revision = reader.revision();
    if (revision == last) continue;
    last = revision;
    fmt::print("{:.4f} {}\n", now_s(), revision);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const auto bus = rds::bus::Participant::create({.vendor = rds::bus::vendor_from_name(argv[1]),
                                                  .domain = std::stoi(argv[2]),
                                                  .node_name = "map_follower"});
  rds::test::MapReader reader(*bus);
  follow(reader);
}
