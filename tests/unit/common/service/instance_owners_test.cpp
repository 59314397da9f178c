// SPDX-License-Identifier: Apache-2.0
#include "common/service/peers/instance_owners.hpp"

#include <gtest/gtest.h>

namespace rds::service {
namespace {

constexpr bus::ParticipantId kTracker{1};
constexpr bus::ParticipantId kStranger{2};

TEST(InstanceOwners, TheFirstParticipantThatIsHeardSpeaksForAnInstance) {
  InstanceOwners owners;
  EXPECT_TRUE(owners.owns(kTracker, 17));
  EXPECT_FALSE(owners.owns(kStranger, 17));
  EXPECT_TRUE(owners.owns(kStranger, 18));
  EXPECT_FALSE(owners.owns(kTracker, 18));
  EXPECT_TRUE(owners.owns(kTracker, 17));
}

TEST(InstanceOwners, InventedInstancesPushNobodyOut) {
  InstanceOwners owners;
  const auto now = InstanceOwners::Clock::now();
  EXPECT_TRUE(owners.owns(kTracker, 0, now));
  for (std::uint64_t i = 1; i < InstanceOwners::kMost; ++i) EXPECT_TRUE(owners.owns(kStranger, i, now));
  EXPECT_FALSE(owners.owns(kStranger, 4711, now));
  EXPECT_FALSE(owners.owns(kStranger, 0, now));
  EXPECT_TRUE(owners.owns(kTracker, 0, now));
}

TEST(InstanceOwners, WhoHasBeenSilentMakesRoom) {
  InstanceOwners owners;
  const auto now = InstanceOwners::Clock::now();
  for (std::uint64_t i = 0; i < InstanceOwners::kMost; ++i) EXPECT_TRUE(owners.owns(kStranger, i, now));
  const auto later = now + 2 * InstanceOwners::kIdleFor;
  EXPECT_TRUE(owners.owns(kTracker, 4711, later));
  EXPECT_TRUE(owners.owns(kTracker, 0, later));
}

}  // namespace
}  // namespace rds::service
