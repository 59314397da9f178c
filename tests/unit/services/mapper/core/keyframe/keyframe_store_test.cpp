// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/keyframe/keyframe_store.hpp"

#include <filesystem>
#include <map>

#include <gtest/gtest.h>

#include "services/mapper/core/keyframe/keyframe_bytes.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "services/mapper/spill_file.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::SyntheticKeyframe;

/// Storage in memory that can be full, or forget.
class FakeStorage : public SpillStorage {
 public:
  struct State {
    std::map<std::uint64_t, map_file::Bytes> rows;
    std::size_t room = SIZE_MAX;
    int puts = 0;

    [[nodiscard]] std::size_t bytes() const {
      std::size_t sum = 0;
      for (const auto& [id, row] : rows) sum += row.size();
      return sum;
    }
  };
  explicit FakeStorage(State& state) : state_(state) {}
  bool put(std::uint64_t id, std::span<const std::uint8_t> bytes) override {
    if (state_.bytes() + bytes.size() > state_.room) return false;
    state_.rows[id] = {bytes.begin(), bytes.end()};
    ++state_.puts;
    return true;
  }
  std::optional<map_file::Bytes> get(std::uint64_t id) override {
    const auto row = state_.rows.find(id);
    return row == state_.rows.end() ? std::nullopt : std::optional(row->second);
  }
  void erase(std::uint64_t id) override { state_.rows.erase(id); }
  void clear() override { state_.rows.clear(); }

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
  const auto record = test::measured(input);
  const auto bytes = to_bytes(record);
  const auto back = record_from_bytes(bytes);
  ASSERT_TRUE(back) << back.error();
  EXPECT_EQ(back->depth_tenth_mm, record.depth_tenth_mm);
  EXPECT_EQ(back->rgb, record.rgb);
  EXPECT_EQ(back->classes, record.classes);
  EXPECT_EQ(back->grid.camera, record.grid.camera);
  EXPECT_EQ(to_bytes(*back), bytes);
  EXPECT_LT(bytes.size(), 5 * record.size());
}

TEST(KeyframeBytes, AnyByteMissingIsRefused) {
  const auto input = keyframe(3);
  const auto bytes = to_bytes(test::measured(input));
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
  EXPECT_EQ(to_bytes(narrow.map().tree()), to_bytes(roomy.map().tree()));
  EXPECT_EQ(test::saved_bytes(narrow), test::saved_bytes(roomy));
  EXPECT_EQ(narrow.archive().poses().size(), kKeyframes);
  EXPECT_EQ(narrow.archive().lost(), 0U);
}

TEST(KeyframeStore, AFullDiskLeavesKeyframesWhereTheyAreAndCountsThem) {
  FakeStorage::State disk;
  disk.room = 200'000;
  SemanticMapper mapper(with_little_memory(), 0, std::make_unique<FakeStorage>(disk));
  show_all(mapper);
  EXPECT_GT(mapper.archive().lost(), 0U);
  EXPECT_EQ(mapper.archive().size(), kKeyframes);
  EXPECT_EQ(mapper.archive().poses().size(), kKeyframes - mapper.archive().lost());
  mapper.apply_poses(corrected(kKeyframes));
  EXPECT_TRUE(
      test::is_occupied(mapper.map().tree(), keyframe(4).map_from_camera * test::point_at(60, 30, 3.0)));
}

TEST(KeyframeStore, ATornFileCostsItsKeyframesOnly) {
  FakeStorage::State disk;
  SemanticMapper mapper(with_little_memory(), 0, std::make_unique<FakeStorage>(disk));
  show_all(mapper);
  ASSERT_GT(disk.rows.size(), 2U);
  disk.rows.begin()->second[5'000] ^= 1;
  disk.rows.rbegin()->second.pop_back();
  auto moved = corrected(kKeyframes);
  for (auto& pose : moved) pose.map_from_camera.translation().x() += 1;
  mapper.apply_poses(moved);  // a record is read when its keyframe moves
  EXPECT_EQ(mapper.archive().lost(), 2U);
  EXPECT_EQ(mapper.archive().poses().size(), kKeyframes - 2);
  EXPECT_EQ(mapper.archive().size(), kKeyframes);
}

TEST(KeyframeStore, SavesOnceWhatHasNotChanged) {
  FakeStorage::State disk;
  KeyframeStore records(std::make_unique<FakeStorage>(disk));
  const auto record = [](std::uint64_t id) { return test::measured(keyframe(id)); };
  for (std::uint64_t id = 0; id < 3; ++id) records.put(record(id));
  EXPECT_TRUE(records.save());
  EXPECT_TRUE(records.save());
  EXPECT_TRUE(records.spill_oldest());
  EXPECT_EQ(disk.puts, 3);
  records.put(record(1));
  EXPECT_TRUE(records.save());
  EXPECT_EQ(disk.puts, 4);
  records.erase(1);
  EXPECT_EQ(disk.rows.size(), 2U);
}

TEST(SpillFile, GivesBackWhatItTookAndRefusesAFolderThatIsNone) {
  SpillFile file{std::filesystem::path()};
  const map_file::Bytes bytes{1, 2, 3};
  EXPECT_TRUE(file.put(4, map_file::Bytes(100, 7)));
  EXPECT_TRUE(file.put(5, bytes));
  EXPECT_EQ(file.get(5), bytes);
  EXPECT_EQ(file.get(6), std::nullopt);
  file.erase(5);
  EXPECT_EQ(file.get(5), std::nullopt);
  SpillFile nowhere("/nonexistent/folder");
  EXPECT_FALSE(nowhere.put(1, bytes));
}

/// The temporary files without a name that this process has open, together.
std::uintmax_t bytes_of_nameless_files() {
  std::uintmax_t sum = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code gone;
    const auto target = std::filesystem::read_symlink(entry.path(), gone).string();
    if (target.ends_with("(deleted)")) sum += std::filesystem::file_size(entry.path(), gone);
  }
  return sum;
}

TEST(SpillFile, UsesAgainWhatWasErased) {
  SpillFile file{std::filesystem::path()};
  for (std::uint64_t id = 0; id < 10; ++id) ASSERT_TRUE(file.put(id, map_file::Bytes(300'000, 1)));
  const auto ten = bytes_of_nameless_files();
  for (std::uint64_t id = 10; id < 60; ++id) {
    file.erase(id - 10);
    ASSERT_TRUE(file.put(id, map_file::Bytes(300'000, 1)));
    ASSERT_TRUE(file.put(id, map_file::Bytes(300'000, 2)));  // late boxes
  }
  EXPECT_GT(ten, 3'000'000U);
  EXPECT_LT(bytes_of_nameless_files(), ten + 700'000);
}

}  // namespace
}  // namespace rds::mapper
