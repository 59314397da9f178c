// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/links/link_notices.hpp"

#include <gmock/gmock.h>

namespace rds::bus::detail {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Lines as Zenoh 1.10.2 logs them.
class LinkNoticesTest : public ::testing::Test {
 protected:
  std::vector<std::string> said_;
  LinkNotices notices_{[this](const std::string& sentence) { said_.push_back(sentence); }};

  void not_reached(const std::string& endpoint, const std::string& error) {
    notices_.take("Unable to connect to configured peer " + endpoint + "! " + error + ". Retry in 1s.");
  }
};

TEST_F(LinkNoticesTest, WhoIsNotReachedIsNamedOnceAndOnceMoreWhenHeIs) {
  for (int i = 0; i < 3; ++i)
    not_reached("tcp/10.0.0.7:9999",
                "Can not create a new TCP link bound to tcp/10.0.0.7:9999#so_sndbuf=32768: [10.0.0.7:9999: "
                "Connection refused (os error 111) at /x/zenoh-link-commons-1.10.2/src/tcp.rs:105.] at "
                "/x/zenoh-link-commons-1.10.2/src/tcp.rs:133. at /x/zenoh-link-tcp/src/unicast.rs:275.");
  notices_.take("Successfully connected to configured peer tcp/10.0.0.7:9999");
  notices_.take("Successfully connected to configured peer tcp/10.0.0.7:9999");
  EXPECT_THAT(
      said_,
      ElementsAre("tcp/10.0.0.7:9999 is not reached: Connection refused (os error 111); it is tried again",
                  "tcp/10.0.0.7:9999 is reached"));
}

TEST_F(LinkNoticesTest, NothingIsSaidOfWhomNobodyNamed) {
  notices_.ignore("tcp/127.0.0.1:7447");
  not_reached("tcp/127.0.0.1:7447", "Connection refused (os error 111)");
  notices_.take("Successfully connected to configured peer tcp/127.0.0.1:7447");
  notices_.take("Successfully connected to configured peer tcp/10.0.0.7:7447");
  EXPECT_THAT(said_, IsEmpty());
}

TEST_F(LinkNoticesTest, ACertificateIsToldOnBothSides) {
  not_reached("tls/10.0.0.7:7447",
              "Can not create a new TLS link bound to IpAddress(V4(Ipv4Addr([10, 0, 0, 7]))): invalid peer "
              "certificate: BadSignature at /x/zenoh-link-tls/src/unicast.rs:363.");
  for (int i = 0; i < 3; ++i)
    notices_.take("received fatal alert: DecryptError. Hint: increase the system open file limit.");
  notices_.take(
      "received corrupt message of type InvalidContentType. Hint: increase the system open file limit.");
  notices_.take("b2c1 did not match any configured ACL subject. Default permission `Deny` will be applied");
  EXPECT_THAT(
      said_,
      ElementsAre(
          "tls/10.0.0.7:7447 is not reached: its certificate is of another authority; it is tried again",
          "a program is refused: the other side takes our certificate for one of another authority",
          "a program is refused: the other side does not encrypt",
          "session b2c1 has a certificate whose name is not on the list of access.p7s: what it says is "
          "dropped"));
}

TEST_F(LinkNoticesTest, AnotherVersionOfTheProtocolIsTold) {
  notices_.take(
      "Rejecting InitSyn on tcp/1 => tcp/2 because of unsupported Zenoh protocol version (expected: 9, "
      "received: "
      "8) from: b2c1 at /x/zenoh-transport/src/unicast/establishment/accept.rs:187.");
  not_reached(
      "tcp/10.0.0.7:7447",
      "Received a close message (reason 2) in response to an InitSyn on: tcp/1 => tcp/2 at /x/open.rs:12.");
  EXPECT_THAT(
      said_,
      ElementsAre(
          "a program is refused: it speaks another version of Zenoh's protocol",
          "tcp/10.0.0.7:7447 is not reached: it refuses our version of Zenoh's protocol; it is tried again"));
}

TEST_F(LinkNoticesTest, WhatIsCutOrUnknownHarmsNothing) {
  for (const char* line :
       {"", "Unable to connect to configured peer ", "Unable to connect to configured peer x! ",
        "Unable to connect to configured peer y! a link bound to ): ", "Zenoh can be reached at: tcp"})
    notices_.take(line);
  EXPECT_THAT(said_, SizeIs(3));
}

TEST_F(LinkNoticesTest, StrangersCannotFillTheLog) {
  for (int i = 0; i < 1000; ++i)
    notices_.take(std::to_string(i) + " did not match any configured ACL subject");
  EXPECT_THAT(said_, SizeIs(64));
}

}  // namespace
}  // namespace rds::bus::detail
