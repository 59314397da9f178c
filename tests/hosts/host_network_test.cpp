// SPDX-License-Identifier: Apache-2.0
// What hosts of a test see of each other: measured with datagrams between them.
#include "tests/hosts/host_network.hpp"

#include <optional>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

namespace rds::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr std::uint16_t kPort = 7000;
constexpr int kBufferBytes = 16 << 20;  // whatever arrives before it is read
constexpr timeval kPatience{.tv_sec = 0, .tv_usec = 300'000};

/// A socket on the host on which it is made.
class Datagrams {
 public:
  explicit Datagrams(const std::string& address) {
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof kPatience);
    setsockopt(socket_, SOL_SOCKET, SO_RCVBUFFORCE, &kBufferBytes, sizeof kBufferBytes);
    const sockaddr_in own = at(address);
    if (bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0)
      throw std::runtime_error(address + ": cannot be bound");
  }
  ~Datagrams() { close(socket_); }
  Datagrams(const Datagrams&) = delete;
  Datagrams& operator=(const Datagrams&) = delete;

  void send(const std::string& address, std::size_t bytes) const {
    const std::vector<char> data(bytes);
    const sockaddr_in there = at(address);
    sendto(socket_, data.data(), data.size(), 0, reinterpret_cast<const sockaddr*>(&there), sizeof there);
  }
  /// @return its size; nullopt if none comes.
  [[nodiscard]] std::optional<std::size_t> receive() const {
    std::vector<char> data(65'536);
    const ssize_t size = recv(socket_, data.data(), data.size(), 0);
    return size < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(size));
  }

 private:
  static sockaddr_in at(const std::string& address) {
    sockaddr_in result{};
    result.sin_family = AF_INET;
    result.sin_port = htons(kPort);
    inet_pton(AF_INET, address.c_str(), &result.sin_addr);
    return result;
  }
  int socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
};

/// Two hosts, each with a socket.
class TwoHosts {
 public:
  explicit TwoHosts(const Link& link) : network({"A", "B"}, link) {
    const OnHost here(network, "A");
    a.emplace(network.address("A"));
    const OnHost there(network, "B");
    b.emplace(network.address("B"));
    send_both();  // who is where
  }
  void send_both() {
    for (int i = 0; i < 20; ++i) {
      a->send(network.address("B"), 1);
      b->send(network.address("A"), 1);
    }
    while (a->receive()) {
    }
    while (b->receive()) {
    }
  }

  HostNetwork network;
  std::optional<Datagrams> a;
  std::optional<Datagrams> b;
};

class HostNetworkTest : public testing::Test {
 protected:
  void SetUp() override {
    if (const auto reason = HostNetwork::why_not(); !reason.empty()) GTEST_SKIP() << reason;
  }
};

TEST_F(HostNetworkTest, CarriesDatagramsOfAnySize) {
  for (const Link& link : {Link{}, Link{.impairment = {.delay_ms = 1}}}) {
    TwoHosts hosts(link);
    for (const std::size_t bytes : {100UL, 1400UL, 1500UL, 60'000UL}) {
      hosts.a->send(hosts.network.address("B"), bytes);
      EXPECT_EQ(hosts.b->receive(), bytes);
      hosts.b->send(hosts.network.address("A"), bytes);
      EXPECT_EQ(hosts.a->receive(), bytes);
    }
  }
}

TEST_F(HostNetworkTest, DelaysBothWays) {
  TwoHosts hosts({.impairment = {.delay_ms = 20}});
  const auto sent = Clock::now();
  hosts.a->send(hosts.network.address("B"), 100);
  ASSERT_TRUE(hosts.b->receive());
  EXPECT_GE(Clock::now() - sent, 20ms);
  hosts.b->send(hosts.network.address("A"), 100);
  ASSERT_TRUE(hosts.a->receive());
  EXPECT_GE(Clock::now() - sent, 40ms);
}

TEST_F(HostNetworkTest, LosesTheShareItShould) {
  TwoHosts hosts({.impairment = {.loss = 0.1}});
  constexpr int kSent = 2000;
  int arrived = 0;
  for (int i = 0; i < kSent; ++i) hosts.a->send(hosts.network.address("B"), 100);
  while (hosts.b->receive()) ++arrived;
  EXPECT_NEAR(arrived, 1800, 60);
}

TEST_F(HostNetworkTest, BoundsTheRate) {
  TwoHosts hosts({.rate_mbit = 20});
  const auto begin = Clock::now();
  constexpr int kSent = 500;  // 5.2 Mbit on the link, fewer than its queue holds
  for (int i = 0; i < kSent; ++i) hosts.a->send(hosts.network.address("B"), 1250);
  int arrived = 0;
  auto last = begin;
  for (; arrived < kSent && hosts.b->receive(); ++arrived) last = Clock::now();
  EXPECT_GE(arrived, kSent / 2);
  const double mbit = arrived * 1292 * 8 / 1e6;
  EXPECT_LE(mbit / std::chrono::duration<double>(last - begin).count(), 25);
}

TEST_F(HostNetworkTest, PullsOutALinkAndPlugsItInAgain) {
  TwoHosts hosts(Link{});
  hosts.network.unplug("B");
  hosts.a->send(hosts.network.address("B"), 100);
  EXPECT_EQ(hosts.b->receive(), std::nullopt);
  hosts.network.plug("B");
  hosts.send_both();
  hosts.a->send(hosts.network.address("B"), 100);
  EXPECT_EQ(hosts.b->receive(), 100U);
}

}  // namespace
}  // namespace rds::test
