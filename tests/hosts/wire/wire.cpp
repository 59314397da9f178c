// SPDX-License-Identifier: Apache-2.0
// wire A B DELAY_MS JITTER_MS LOSS SEED: carries frames between two interfaces, in both directions, as a link
// of that delay and loss would. For kernels without netem.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>

#include <poll.h>
#include <sys/resource.h>

#include "tests/hosts/wire/impaired_direction.hpp"
#include "tests/hosts/wire/packet_port.hpp"

namespace rds::test {
namespace {

using Time = ImpairedDirection::Time;

constexpr int kFramesInTurn = 256;  // of one direction, before the other one has its turn
constexpr int kPriority = -15;      // a link does not wait for a processor

Time now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

void sleep_until(std::optional<Time> due, const PacketPort& a, const PacketPort& b) {
  std::array<pollfd, 2> ports{{{a.descriptor(), POLLIN, 0}, {b.descriptor(), POLLIN, 0}}};
  const Time left = std::max(due.value_or(now()) - now(), Time(0));
  const timespec limit{left.count() / 1'000'000'000, left.count() % 1'000'000'000};
  ppoll(ports.data(), ports.size(), due ? &limit : nullptr, nullptr);
}

void carry(PacketPort& from, PacketPort& to, ImpairedDirection& direction) {
  for (int i = 0; i < kFramesInTurn; ++i) {
    auto frame = from.receive();
    if (!frame) break;
    direction.push(std::move(*frame), now());
  }
  while (const auto frame = direction.pop(now())) to.send(*frame);
}

[[noreturn]] void run(const std::string& a, const std::string& b, const Impairment& impairment,
                      std::uint32_t seed) {
  PacketPort port_a(a);
  PacketPort port_b(b);
  ImpairedDirection a_to_b(impairment, seed);
  ImpairedDirection b_to_a(impairment, seed + 1);
  setpriority(PRIO_PROCESS, 0, kPriority);
  std::puts("carries frames");
  std::fflush(stdout);
  while (true) {
    std::optional<Time> due = a_to_b.next_due();
    if (const auto other = b_to_a.next_due(); other && (!due || *other < *due)) due = other;
    sleep_until(due, port_a, port_b);
    carry(port_a, port_b, a_to_b);
    carry(port_b, port_a, b_to_a);
  }
}

}  // namespace
}  // namespace rds::test

int main(int argc, char** argv) {
  try {
    if (argc != 7) throw std::invalid_argument("expected A B DELAY_MS JITTER_MS LOSS SEED");
    rds::test::run(
        argv[1], argv[2],
        {.delay_ms = std::stod(argv[3]), .jitter_ms = std::stod(argv[4]), .loss = std::stod(argv[5])},
        static_cast<std::uint32_t>(std::stoul(argv[6])));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "wire: %s\n", e.what());
    return 2;
  }
}
