// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree/octree_replica.hpp"

#include <gmock/gmock.h>

#include "tests/unit/services/mapper/core/random_keyframes.hpp"

namespace rds::mapper {
namespace {

using test::expect_same;
using test::PublishedMap;
using test::RandomKeyframes;
constexpr std::uint64_t kEpoch = 0xabcdef;

class MapperAndReplica : public testing::Test {
 protected:
  /// Integrates a keyframe, of which the replica knows. @return the replica's tree.
  std::vector<std::uint8_t> tree_after_one_keyframe() {
    EXPECT_EQ(replica.apply(mapper.integrate(keyframes.next())).status, ReplicaStatus::kApplied);
    return to_bytes(replica.tree());
  }

  RandomKeyframes keyframes;
  SemanticMapper mapper{MapperConfig{}, kEpoch};
  OctreeReplica replica;
};

TEST_F(MapperAndReplica, FollowsARandomSequenceOfKeyframesAndCorrections) {
  for (std::uint64_t id = 0; id < 8; ++id) {
    EXPECT_EQ(replica.apply(mapper.integrate(keyframes.next())).status, ReplicaStatus::kApplied);
    if (id % 4 == 3) {
      const std::vector<KeyframePose> moved{{id, 0, keyframes.pose()}, {id / 2, 0, keyframes.pose()}};
      EXPECT_EQ(replica.apply(mapper.apply_poses(moved)).status, ReplicaStatus::kApplied);
    }
    expect_same(replica, mapper);
  }
}

TEST_F(MapperAndReplica, JoinsLateWithTheFullMapAndGoesOnWithDeltas) {
  for (int i = 0; i < 4; ++i) mapper.integrate(keyframes.next());
  EXPECT_EQ(replica.apply(mapper.integrate(keyframes.next())).status, ReplicaStatus::kGap);
  EXPECT_FALSE(replica.is_valid());
  const PublishedMap published(mapper, 0);
  EXPECT_EQ(replica.apply(published.full).status, ReplicaStatus::kApplied);
  expect_same(replica, mapper);
  EXPECT_EQ(replica.apply(mapper.integrate(keyframes.next())).status, ReplicaStatus::kApplied);
  expect_same(replica, mapper);
  EXPECT_EQ(replica.apply(published.full).status, ReplicaStatus::kOld);
}

TEST_F(MapperAndReplica, NoticesGapsOtherEpochsAndOtherResolutions) {
  const auto first = mapper.integrate(keyframes.next());
  mapper.integrate(keyframes.next());
  auto third = mapper.integrate(keyframes.next());
  ASSERT_EQ(replica.apply(first).status, ReplicaStatus::kApplied);
  EXPECT_EQ(replica.apply(first).status, ReplicaStatus::kOld);
  EXPECT_EQ(replica.apply(third).status, ReplicaStatus::kGap);
  third.base_revision = 1;
  third.map_epoch = kEpoch + 1;
  EXPECT_EQ(replica.apply(third).status, ReplicaStatus::kOtherMap);
  third.map_epoch = kEpoch;
  third.resolution = 0.1;
  EXPECT_EQ(replica.apply(third).status, ReplicaStatus::kOtherResolution);
  EXPECT_EQ(replica.revision(), 1U);
}

TEST_F(MapperAndReplica, RejectsHostileDeltasAndStaysAsItWas) {
  const auto before = tree_after_one_keyframe();
  const auto good = mapper.integrate(keyframes.next());
  const auto status = [&](auto spoil) {
    auto bad = good;
    spoil(bad);
    const auto answer = replica.apply(bad);
    EXPECT_FALSE(answer.reason.empty());
    return answer.status;
  };
  EXPECT_EQ(status([](auto& d) { d.keys.pop_back(); }), ReplicaStatus::kMalformed);
  EXPECT_EQ(status([](auto& d) { d.labels.push_back(1); }), ReplicaStatus::kMalformed);
  EXPECT_EQ(status([](auto& d) { d.colors.clear(); }), ReplicaStatus::kMalformed);
  EXPECT_EQ(status([](auto& d) { d.deleted_keys.push_back(1); }), ReplicaStatus::kMalformed);
  EXPECT_EQ(status([](auto& d) { d.log_odds[0] = NAN; }), ReplicaStatus::kMalformed);
  EXPECT_EQ(status([](auto& d) { d.log_odds[0] = INFINITY; }), ReplicaStatus::kMalformed);
  EXPECT_EQ(status([](auto& d) { d.resolution = 0; }), ReplicaStatus::kMalformed);
  EXPECT_EQ(status([](auto& d) { d.resolution = NAN; }), ReplicaStatus::kMalformed);
  EXPECT_EQ(status([](auto& d) { d.revision = d.base_revision; }), ReplicaStatus::kMalformed);
  EXPECT_EQ(to_bytes(replica.tree()), before);
  EXPECT_EQ(replica.apply(good).status, ReplicaStatus::kApplied);
}

TEST_F(MapperAndReplica, FollowsAMapperThatBeganAnewInTheSameEpoch) {
  for (int i = 0; i < 3; ++i) replica.apply(mapper.integrate(keyframes.next()));
  ASSERT_EQ(replica.revision(), 3U);
  SemanticMapper restarted(MapperConfig{}, kEpoch);
  for (int i = 0; i < 4; ++i) {  // its fourth delta continues revision 3, but of another map
    MapDelta delta = restarted.integrate(keyframes.next());
    delta.map_id = 1;
    if (i > 0) {
      EXPECT_EQ(replica.apply(delta).status, ReplicaStatus::kOtherMap);
    }
  }
  ASSERT_EQ(replica.apply(PublishedMap(restarted, 1).full).status, ReplicaStatus::kApplied);
  expect_same(replica, restarted);
}

TEST_F(MapperAndReplica, RefusesAFullMapThatDoesNotFit) {
  const auto before = tree_after_one_keyframe();
  mapper.integrate(keyframes.next());
  const PublishedMap published(mapper, 0);
  FullMap full = published.full;
  full.resolution = 0.1;
  EXPECT_EQ(replica.apply(full).status, ReplicaStatus::kOtherResolution);
  full = published.full;
  const std::vector<std::uint16_t> half_a_key{1};
  full.label_keys = half_a_key;
  EXPECT_EQ(replica.apply(full).status, ReplicaStatus::kMalformed);
  full = published.full;
  full.payload = full.payload.first(full.payload.size() / 2);
  EXPECT_EQ(replica.apply(full).status, ReplicaStatus::kMalformed);
  EXPECT_TRUE(to_bytes(replica.tree()) == before);
  EXPECT_EQ(replica.apply(published.full).status, ReplicaStatus::kApplied);
}

TEST_F(MapperAndReplica, DeletingEverythingLeavesAnEmptyTree) {
  const auto first = mapper.integrate(keyframes.next());
  ASSERT_EQ(replica.apply(first).status, ReplicaStatus::kApplied);
  MapDelta empty;
  empty.map_epoch = kEpoch;
  empty.base_revision = 1;
  empty.revision = 2;
  empty.resolution = 0.05;
  empty.deleted_keys = first.keys;
  EXPECT_EQ(replica.apply(empty).status, ReplicaStatus::kApplied);
  EXPECT_EQ(replica.tree().size(), 0U);
  EXPECT_TRUE(to_bytes(replica.tree()).empty());
}

}  // namespace
}  // namespace rds::mapper
