// SPDX-License-Identifier: Apache-2.0
#include "common/bus/peer_addresses.hpp"

#include <gmock/gmock.h>

#include "common/bus/participant.hpp"

namespace rds::bus {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(PeerAddresses, NamesAndAddresses) {
  EXPECT_THAT(peer_addresses("10.0.0.7,localhost"), ElementsAre("10.0.0.7", "127.0.0.1"));
  EXPECT_THAT(peer_addresses(""), IsEmpty());
}

TEST(PeerAddresses, UnknownNameIsSaid) {
  try {
    peer_addresses("127.0.0.1,nowhere.invalid");
    FAIL();
  } catch (const BusError& e) {
    EXPECT_THAT(e.what(), HasSubstr("peer 'nowhere.invalid': "));
  }
  EXPECT_THROW(peer_addresses("127.0.0.1,,localhost"), BusError);
}

}  // namespace
}  // namespace rds::bus
