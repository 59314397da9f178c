// SPDX-License-Identifier: Apache-2.0
#include "common/service/peers/peer_watch.hpp"

#include <gmock/gmock.h>

namespace rds::service {
namespace {

using namespace std::chrono_literals;
namespace Role = rds_msgs::msg::ServiceStatus_Constants;

class PeerWatchTest : public ::testing::Test {
 protected:
  /// Looks four times a second from `from` to `to`, both after the start.
  std::optional<std::string> look(std::chrono::milliseconds from, std::chrono::milliseconds to) {
    std::optional<std::string> said;
    for (auto t = from; t <= to; t += 250ms) said = watch.look(known, start + t);
    return said;
  }
  void hear(std::uint64_t instance, std::uint8_t role, std::chrono::milliseconds at) {
    Peer peer;
    peer.status.service("rds-mapper");
    peer.status.machine("nas");
    peer.status.instance(instance);
    peer.status.role(role);
    peer.heard = start + at;
    std::erase_if(known, [&](const Peer& p) { return p.status.instance() == instance; });
    known.push_back(peer);
  }

  PeerWatch watch;
  PeerWatch::Clock::time_point start = PeerWatch::Clock::now();
  std::vector<Peer> known;
};

TEST_F(PeerWatchTest, WhoFallsSilentIsToldWithinTwoSeconds) {
  hear(1, Role::ACTIVE, 0ms);
  EXPECT_EQ(look(0ms, 1750ms), std::nullopt);
  EXPECT_EQ(look(2000ms, 2000ms), "rds-mapper on nas has been silent for 2 s");
  known.clear();  // forgotten elsewhere
  EXPECT_EQ(look(2250ms, 9000ms), "rds-mapper on nas has been silent for 9 s");
  hear(2, Role::ACTIVE, 9250ms);
  EXPECT_EQ(look(9250ms, 9250ms), std::nullopt) << "started again";
}

TEST_F(PeerWatchTest, WhoSaysGoodbyeIsNotMissed) {
  hear(1, Role::ACTIVE, 0ms);
  EXPECT_EQ(look(0ms, 500ms), std::nullopt);
  hear(1, Role::STOPPED, 600ms);
  EXPECT_EQ(look(750ms, 9000ms), std::nullopt);
}

TEST_F(PeerWatchTest, WhoWasStoppedItselfWaitsFirst) {
  hear(1, Role::ACTIVE, 0ms);
  EXPECT_EQ(look(0ms, 500ms), std::nullopt);
  EXPECT_EQ(look(60'000ms, 61'000ms), std::nullopt) << "not looked for a minute";
  EXPECT_NE(look(61'250ms, 62'250ms), std::nullopt);
}

}  // namespace
}  // namespace rds::service
