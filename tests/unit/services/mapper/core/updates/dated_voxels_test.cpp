// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/updates/dated_voxels.hpp"

#include <map>

#include <gtest/gtest.h>

#include "services/mapper/core/map_snapshot.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "services/mapper/core/updates/map_update.hpp"
#include "tests/unit/services/mapper/core/random_keyframes.hpp"

namespace rds::mapper {
namespace {

using test::expect_same;
using test::RandomKeyframes;

/// What the service begins with, of a map as it is.
MapDelta whole(const SemanticMapper& mapper) {
  MapDelta head;
  head.map_epoch = mapper.map().epoch;
  head.revision = mapper.map().revision;
  return whole_map(mapper.map().tree(), take_snapshot(mapper), head);
}

MapDelta over_the_wire(const MapDelta& delta, const std::vector<std::string>& labels) {
  const auto update = unpack_update(pack({delta, labels}));
  EXPECT_TRUE(update.has_value()) << (update ? "" : update.error());
  return update ? update->delta : MapDelta{};
}

class DatedVoxelsOfAMapper : public testing::Test {
 protected:
  /// A keyframe, or a correction of earlier ones, which deletes voxels, too.
  MapDelta step() {
    if (steps_++ % 3 != 2) return mapper.integrate(keyframes.next());
    const std::uint64_t last = mapper.archive().size() - 1;
    const std::vector<KeyframePose> moved{{last, 0, keyframes.pose()}, {last / 2, 0, keyframes.pose()}};
    return mapper.apply_poses(moved);
  }

  RandomKeyframes keyframes;
  SemanticMapper mapper{MapperConfig{}, 77};
  int steps_ = 0;
};

TEST_F(DatedVoxelsOfAMapper, BringReadersOfEveryRevisionToTheNewestOne) {
  mapper.integrate(keyframes.next());
  DatedVoxels dated(whole(mapper));
  std::vector<std::unique_ptr<OctreeReplica>> readers;  // one of each revision, and one that takes each step
  for (int i = 0; i < 9; ++i) {
    readers.push_back(std::make_unique<OctreeReplica>());
    for (const auto& reader : readers) {  // each is behind by another number of steps
      if ((i + static_cast<int>(&reader - readers.data())) % 3 != 0 && reader->is_valid()) continue;
      if (reader->is_valid() && reader->revision() == dated.revision()) continue;
      const auto delta = dated.since(reader->is_valid() ? reader->revision() : 0);
      ASSERT_TRUE(delta);
      EXPECT_EQ(reader->apply(over_the_wire(*delta, {""})).status, ReplicaStatus::kApplied);
      expect_same(*reader, mapper);
    }
    const MapDelta delta = step();
    if (!delta.is_noop()) {
      ASSERT_TRUE(dated.add(delta));
    }
  }
}

TEST_F(DatedVoxelsOfAMapper, RefuseAStepThatDoesNotFollow) {
  mapper.integrate(keyframes.next());
  DatedVoxels dated(whole(mapper));
  mapper.integrate(keyframes.next());
  MapDelta third = mapper.integrate(keyframes.next());
  EXPECT_FALSE(dated.add(third));
  third.base_revision = dated.revision();
  third.map_id = 5;
  EXPECT_FALSE(dated.add(third));
  EXPECT_EQ(dated.revision(), 1U);
  EXPECT_FALSE(dated.since(2));
}

/// Steps of single voxels: which are there is easily told.
MapDelta step_of(std::uint64_t revision, std::vector<std::uint16_t> set, std::vector<std::uint16_t> deleted) {
  MapDelta delta;
  delta.base_revision = revision - 1;
  delta.revision = revision;
  delta.resolution = 0.05;
  for (const std::uint16_t x : set) delta.keys.insert(delta.keys.end(), {x, 7, 7});
  for (const std::uint16_t x : deleted) delta.deleted_keys.insert(delta.deleted_keys.end(), {x, 7, 7});
  delta.log_odds.assign(set.size(), 0.5F);
  delta.labels.assign(set.size(), 0);
  delta.colors.assign(3 * set.size(), 1);
  return delta;
}

TEST(DatedVoxels, TellEachVoxelOnceWithItsNewestState) {
  DatedVoxels dated(step_of(1, {10, 11, 12}, {}));
  ASSERT_TRUE(dated.add(step_of(2, {11, 13}, {10})));
  ASSERT_TRUE(dated.add(step_of(3, {10, 11}, {13})));
  EXPECT_EQ(dated.since(1)->keys, (std::vector<std::uint16_t>{10, 7, 7, 11, 7, 7}));
  EXPECT_EQ(dated.since(1)->deleted_keys, (std::vector<std::uint16_t>{13, 7, 7}));
  EXPECT_EQ(dated.since(0)->keys.size(), 9U);
  EXPECT_TRUE(dated.since(0)->deleted_keys.empty());
  EXPECT_TRUE(dated.since(3)->keys.empty());
}

TEST(DatedVoxels, ForgetDeletedOnesThatOutnumberTheMap) {
  DatedVoxels dated(step_of(1, {1, 2, 3, 4}, {}));
  ASSERT_TRUE(dated.add(step_of(2, {}, {1, 2})));
  EXPECT_TRUE(dated.since(1));
  ASSERT_TRUE(dated.add(step_of(3, {}, {3})));
  EXPECT_FALSE(dated.since(1));
  EXPECT_FALSE(dated.since(2));
  EXPECT_TRUE(dated.since(3));
  EXPECT_EQ(dated.since(0)->keys, (std::vector<std::uint16_t>{4, 7, 7}));
}

}  // namespace
}  // namespace rds::mapper
