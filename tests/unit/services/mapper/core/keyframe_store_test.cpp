// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/keyframe_store.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "services/mapper/core/keyframe_bytes.hpp"
#include "services/mapper/core/tree_bytes.hpp"
#include "services/mapper/spill_file.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::SyntheticKeyframe;

/// Storage in memory that can be full, or forget.
class FakeStorage : public SpillStorage {
 public:
  struct State {
    map_file::Bytes bytes;
    std::size_t room = SIZE_MAX;
  };
  explicit FakeStorage(State& state) : state_(state) {}
  std::optional<std::uint64_t> append(std::span<const std::uint8_t> bytes) override {
    if (state_.bytes.size() + bytes.size() > state_.room) return std::nullopt;
    const std::uint64_t begin = state_.bytes.size();
    state_.bytes.insert(state_.bytes.end(), bytes.begin(), bytes.end());
    return begin;
  }
  bool read(std::uint64_t offset, std::span<std::uint8_t> bytes) override {
    if (offset + bytes.size() > state_.bytes.size()) return false;
    std::copy_n(state_.bytes.begin() + static_cast<std::ptrdiff_t>(offset), bytes.size(), bytes.begin());
    return true;
  }
  void clear() override { state_.bytes.clear(); }

 private:
  State& state_;
};

KeyframeInput keyframe(std::uint64_t id) {
  geometry::Pose pose = geometry::Pose::Identity();
  pose.translation().x() = 0.05 * static_cast<double>(id);
  return SyntheticKeyframe(id)
      .rectangle({120, 40, 80, 180}, 1.5)
      .rectangle({20, 120, 60, 60}, 2.0)
      .rectangle({250, 20, 40, 40}, 0)
      .box("person", {120, 40, 80, 100}, true)
      .box("chair", {20, 120, 60, 60}, false)
      .movable_cells({120, 180, 80, 20})
      .pose(pose);
}

std::vector<KeyframePose> corrected(std::uint64_t count) {
  std::vector<KeyframePose> poses;
  for (std::uint64_t id = 0; id < count; ++id) {
    geometry::Pose pose = keyframe(id).map_from_camera;
    pose.translation().y() += 0.03 * static_cast<double>(id);
    poses.push_back({id, 0, pose});
  }
  return poses;
}

MapperConfig with_little_memory() {
  MapperConfig config;
  config.correction.memory_mb = 0.15;  // a keyframe of 160×120
  return config;
}

constexpr std::uint64_t kKeyframes = 8;

void show_all(SemanticMapper& mapper) {
  for (std::uint64_t id = 0; id < kKeyframes; ++id) mapper.integrate(keyframe(id));
}

TEST(KeyframeBytes, ComeBackAsTheyWere) {
  const auto input = keyframe(3);
  const MapperConfig config;
  const auto record =
      make_record(input, config.sampling, sample_rays(input.camera, config.sampling.stride_px));
  const auto bytes = to_bytes(record);
  const auto back = record_from_bytes(bytes);
  ASSERT_TRUE(back) << back.error();
  EXPECT_EQ(back->depth_tenth_mm, record.depth_tenth_mm);
  EXPECT_EQ(back->rgb, record.rgb);
  EXPECT_EQ(back->use, record.use);
  EXPECT_EQ(back->camera, record.camera);
  EXPECT_EQ(to_bytes(*back), bytes);
  EXPECT_LT(bytes.size(), 5 * record.size());
}

TEST(KeyframeBytes, AnyByteMissingIsRefused) {
  const auto input = keyframe(3);
  const auto bytes = to_bytes(make_record(input, {}, sample_rays(input.camera, 2)));
  for (std::size_t size = 0; size < bytes.size(); size += size < 300 ? 1 : 997)
    EXPECT_FALSE(record_from_bytes(std::span(bytes).first(size))) << size;
}

TEST(KeyframeStore, SpillingChangesNoBitOfTheMap) {
  SemanticMapper roomy(MapperConfig{});
  SemanticMapper narrow(with_little_memory(), 0, std::make_unique<SpillFile>(std::filesystem::path()));
  show_all(roomy);
  show_all(narrow);
  for (auto* mapper : {&roomy, &narrow}) {
    const auto late = *keyframe(1).boxes;
    EXPECT_TRUE(mapper->set_boxes(1, std::span(late).first(1)));
    mapper->apply_poses(corrected(kKeyframes));
  }
  EXPECT_EQ(to_bytes(narrow.tree()), to_bytes(roomy.tree()));
  EXPECT_EQ(narrow.to_bytes(), roomy.to_bytes());
  EXPECT_EQ(narrow.keyframe_poses().size(), kKeyframes);
  EXPECT_EQ(narrow.corrections_lost(), 0U);
}

TEST(KeyframeStore, AFullDiskLeavesKeyframesWhereTheyAreAndCountsThem) {
  FakeStorage::State disk;
  disk.room = 200'000;
  SemanticMapper mapper(with_little_memory(), 0, std::make_unique<FakeStorage>(disk));
  show_all(mapper);
  EXPECT_GT(mapper.corrections_lost(), 0U);
  EXPECT_EQ(mapper.keyframes(), kKeyframes);
  EXPECT_EQ(mapper.keyframe_poses().size(), kKeyframes - mapper.corrections_lost());
  mapper.apply_poses(corrected(kKeyframes));
  EXPECT_TRUE(test::is_occupied(mapper.tree(), keyframe(4).map_from_camera * test::point_at(60, 30, 3.0)));
}

TEST(KeyframeStore, ATornFileCostsItsKeyframesOnly) {
  FakeStorage::State disk;
  SemanticMapper mapper(with_little_memory(), 0, std::make_unique<FakeStorage>(disk));
  show_all(mapper);
  ASSERT_GT(disk.bytes.size(), 10'000U);
  disk.bytes[5'000] ^= 1;                        // the first keyframe
  disk.bytes.resize(disk.bytes.size() - 1'000);  // the last one
  mapper.apply_poses(corrected(kKeyframes));
  EXPECT_EQ(mapper.corrections_lost(), 2U);
  EXPECT_EQ(mapper.keyframe_poses().size(), kKeyframes - 2);
  EXPECT_EQ(mapper.keyframes(), kKeyframes);
}

TEST(SpillFile, GivesBackWhatItTookAndRefusesAFolderThatIsNone) {
  SpillFile file{std::filesystem::path()};
  const map_file::Bytes bytes{1, 2, 3};
  file.append(map_file::Bytes(100, 7));
  const auto at = file.append(bytes);
  ASSERT_TRUE(at);
  map_file::Bytes back(3);
  EXPECT_TRUE(file.read(*at, back));
  EXPECT_EQ(back, bytes);
  EXPECT_FALSE(file.read(*at + 1, back));
  SpillFile nowhere("/nonexistent/folder");
  EXPECT_FALSE(nowhere.append(bytes));
}

}  // namespace
}  // namespace rds::mapper
