// SPDX-License-Identifier: Apache-2.0
// Spoiled sections of map.rds behind their checksums: tracker and loop closer.
#include <gmock/gmock.h>

#include "services/loop_closer/core/loop_closer.hpp"
#include "services/tracker/core/map/map_bytes.hpp"
#include "tests/fuzz/allocation_watch.hpp"
#include "tests/fuzz/feed.hpp"
#include "tests/unit/services/loop_closer/core/synthetic_places.hpp"
#include "tests/unit/services/tracker/core/tracker_scene.hpp"

namespace rds::fuzz {
namespace {

constexpr std::size_t kMemoryOfAnEmptyMap = 1 << 20;

TEST(SectionReaders, SectionOfTheTracker) {
  tracker::TrackerConfig config = tracker::test::small_config();
  config.extraction.features = 150;
  tracker::Tracker tracker(config);
  for (int i = 0; i < 6; ++i)
    tracker.track(tracker::test::picture_of_wall(tracker::test::truth(i), i * tracker::test::kFrameNs), {});
  const auto poses = keyframe_poses(tracker.map());
  const double fx = tracker::test::small_camera().fx;
  const std::vector<Bytes> seeds{tracker::to_bytes(tracker.map(), {fx, 1}, config.extraction)};
  feed(
      2, seeds, [](std::size_t bytes) { return kMemoryOfAnEmptyMap + 32 * bytes; },
      [&](const Bytes& bytes) {
        return tracker::map_from_bytes(bytes, poses, config.extraction).has_value();
      });
}

TEST(SectionReaders, SectionOfTheLoopCloser) {
  using namespace loop_closer;
  const SyntheticWorld world = SyntheticWorld::round_room(300, 1);
  LoopCloser closer;
  for (std::uint64_t id = 0; id < 4; ++id) {
    const geometry::Pose pose = looking_out(0.2 * static_cast<double>(id));
    KeyframeFeatures features = world.seen_from(pose, id);
    features.map_epoch = 1;
    features.id = id;
    features.map_from_camera = pose;
    EXPECT_EQ(closer.add(features).refused, "");
  }
  const std::vector<Bytes> seeds{closer.to_bytes()};
  const auto poses = closer.poses();
  const AllocationWatch watch;
  LoopCloser reader;  // the tables of its index; reset() makes another
  const std::size_t tables = watch.peak_bytes();
  feed(
      1, seeds, [&](std::size_t bytes) { return 2 * tables + kMemoryOfAnEmptyMap + 32 * bytes; },
      [&](const Bytes& bytes) { return reader.start_from(bytes, poses).has_value(); });
}

}  // namespace
}  // namespace rds::fuzz
