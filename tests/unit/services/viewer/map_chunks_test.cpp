// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/map/map_chunks.hpp"

#include <random>

#include <gmock/gmock.h>

#include "services/mapper/core/octree/voxel_walk.hpp"
#include "tests/unit/services/viewer/frame_reader.hpp"

namespace rds::viewer {
namespace {

using test::PageMap;

/// A map that changes as a mapper's does.
class MapChunksTest : public ::testing::Test {
 protected:
  /// Sets and deletes voxels at random, some free.
  void step(std::size_t voxels, std::size_t deleted = 0) {
    mapper::MapDelta delta;
    delta.map_epoch = 1;
    delta.map_id = map_id_;
    delta.base_revision = revision_;
    delta.revision = ++revision_;
    delta.resolution = 0.05;
    for (std::size_t i = 0; i < voxels; ++i) {
      delta.keys.insert(delta.keys.end(), {key(), key(), key()});
      delta.log_odds.push_back(random_() % 4 == 0 ? -0.5F : 0.3F + static_cast<float>(random_() % 20) / 10);
      delta.labels.push_back(static_cast<std::uint16_t>(random_() % 3));
      for (int k = 0; k < 3; ++k) delta.colors.push_back(static_cast<std::uint8_t>(random_()));
    }
    if (deleted > 0) {
      std::vector<std::uint16_t> keys;
      mapper::for_each_voxel(map_.tree(), [&](const octomap::OcTreeKey& at, const auto&) {
        if (keys.size() < 3 * deleted) keys.insert(keys.end(), {at[0], at[1], at[2]});
      });
      delta.deleted_keys = keys;
    }
    ASSERT_EQ(map_.apply(delta).status, mapper::ReplicaStatus::kApplied);
    changed_.add(delta.base_revision == 0 ? nullptr : &delta);
  }
  void show() { chunks_.show(map_, std::exchange(changed_, {})); }

  void begin_map() {
    ++map_id_;
    revision_ = 0;
  }

  /// All that a client lacks. @return frames that it took.
  std::size_t update(MapCursor& cursor, PageMap& page) {
    std::size_t frames = 0;
    while (const auto frame = chunks_.next(cursor)) {
      page.apply(*frame);
      ++frames;
    }
    return frames;
  }

  [[nodiscard]] std::map<PageMap::Key, PageMap::Voxel> truth() const {
    std::map<PageMap::Key, PageMap::Voxel> all;
    mapper::for_each_voxel(
        map_.tree(), [&](const octomap::OcTreeKey& at, const octomap::ColorOcTreeNode& node) {
          if (node.getLogOdds() <= 0) return;
          const auto c = node.getColor();
          const auto certainty = static_cast<std::uint8_t>(std::lround((2 * node.getOccupancy() - 1) * 255));
          all[{at[0], at[1], at[2]}] = {{c.r, c.g, c.b, certainty}, map_.label(at)};
        });
    return all;
  }

  std::uint16_t key() { return static_cast<std::uint16_t>(32700 + random_() % 140); }

  std::mt19937 random_{7};
  std::uint64_t map_id_ = 5;
  std::uint64_t revision_ = 0;
  mapper::OctreeReplica map_;
  ChangedChunks changed_;
  MapChunks chunks_;
};

TEST_F(MapChunksTest, AClientThatComesEarlyAndOneThatComesLateHaveTheSameMap) {
  MapCursor early;
  PageMap early_page;
  EXPECT_FALSE(chunks_.next(early)) << "there is no map";
  for (int i = 0; i < 8; ++i) {
    step(500, i % 3 == 2 ? 40 : 0);
    show();
    EXPECT_GE(update(early, early_page), 1U);
    EXPECT_EQ(early_page.voxels(), truth()) << i;
    EXPECT_TRUE(early_page.complete);
    EXPECT_EQ(early_page.revision, revision_);
  }
  MapCursor late;
  PageMap late_page;
  update(late, late_page);
  EXPECT_EQ(late_page.voxels(), truth());
  EXPECT_EQ(chunks_.voxels(), truth().size());
  EXPECT_DOUBLE_EQ(late_page.resolution, 0.05);
}

TEST_F(MapChunksTest, ASlowClientGetsEachChunkOnceHoweverManyStepsItMissed) {
  step(2000);
  show();
  MapCursor cursor;
  PageMap page;
  update(cursor, page);
  std::size_t of_all_steps = 0;
  for (int i = 0; i < 30; ++i) {
    MapCursor quick = cursor;
    step(300);
    show();
    of_all_steps += chunks_.next(quick)->size();
  }
  std::size_t at_once = 0;
  while (const auto frame = chunks_.next(cursor)) {
    at_once += frame->size();
    page.apply(*frame);
  }
  EXPECT_EQ(page.voxels(), truth());
  EXPECT_LT(at_once, of_all_steps / 10);
}

TEST_F(MapChunksTest, ALargeMapComesInPartsOfBoundedSize) {
  for (int i = 0; i < 4; ++i) step(60000);
  show();
  MapCursor cursor;
  PageMap page;
  std::size_t frames = 0;
  while (const auto frame = chunks_.next(cursor)) {
    EXPECT_LE(frame->size(), MapChunks::kFrameBytes + 40 + 16 + 8 * 32 * 32 * 32);
    page.apply(*frame);
    EXPECT_EQ(page.complete, page.voxels().size() == chunks_.voxels());
    ++frames;
  }
  EXPECT_GE(frames, 3U);
  EXPECT_EQ(page.voxels(), truth());
}

TEST_F(MapChunksTest, AnotherMapReplacesAll) {
  step(1000);
  show();
  MapCursor cursor;
  PageMap page;
  update(cursor, page);
  begin_map();
  step(10);
  show();
  update(cursor, page);
  EXPECT_EQ(page.voxels(), truth());
  EXPECT_LE(page.voxels().size(), 10U);
}

TEST_F(MapChunksTest, AFullMapOfWhatIsShownAlreadyIsNotSentAgain) {
  step(1000);
  show();
  MapCursor cursor;
  PageMap page;
  update(cursor, page);
  changed_.all = true;
  show();
  EXPECT_FALSE(chunks_.next(cursor));
}

}  // namespace
}  // namespace rds::viewer
