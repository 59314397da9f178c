// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/joint_save.hpp"

#include <thread>

#include <gmock/gmock.h>

#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::map_file {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const SaveOrder kOrder{"kitchen", "id1", {kTracker, kMapper}};

MapPart tracker_part(std::uint8_t value = 1) {
  return {kTracker, {{kTracker, {value}}, {kKeyframePoses, {value}}}, {}};
}
MapPart mapper_part(std::uint8_t value = 1) {
  return {kMapper, {{kMapper, {value}}}, {{"map.ot", {value}}}};
}
Sections whole(std::uint8_t value) {
  return {{kTracker, {value}}, {kKeyframePoses, {value}}, {kMapper, {value}}};
}

class JointSave : public ::testing::Test {
 protected:
  [[nodiscard]] tl::expected<SaveState, std::string> save(MapPart part, const SaveOrder& order = kOrder) const {
    return save_part(maps.path(), order, std::move(part), {});
  }
  [[nodiscard]] std::vector<std::string> names(const fs::path& below = "") const {
    const auto folder = Folder::open(maps / below);
    return folder ? folder->names() : std::vector<std::string>{"no folder"};
  }
  [[nodiscard]] Sections saved() const { return read_saved_map(maps / "kitchen").value_or(Sections{}); }

  test::TemporaryFolder maps;
};

TEST_F(JointSave, IsPublishedWithItsLastPart) {
  EXPECT_EQ(save(tracker_part()), SaveState::kWaits);
  EXPECT_THAT(names(), ElementsAre(".saving"));
  EXPECT_EQ(save(mapper_part()), SaveState::kPublished);
  EXPECT_THAT(names("kitchen"), ElementsAre("map.ot", "map.rds"));
  EXPECT_EQ(saved(), whole(1));
  EXPECT_THAT(names(".saving"), IsEmpty());
}

TEST_F(JointSave, ReplacesAnEarlierMapAsAWhole) {
  (void)save(tracker_part(1));
  (void)save(mapper_part(1));
  const SaveOrder next{"kitchen", "id2", {kTracker, kMapper}};
  EXPECT_EQ(save(tracker_part(2), next), SaveState::kWaits);
  EXPECT_EQ(saved(), whole(1)) << "half a save is none";
  EXPECT_EQ(save(mapper_part(2), next), SaveState::kPublished);
  EXPECT_EQ(saved(), whole(2));
  EXPECT_THAT(names(".saving"), IsEmpty());
}

TEST_F(JointSave, NeverMixesPartsOfTwoSaves) {
  EXPECT_EQ(save(tracker_part(1)), SaveState::kWaits);
  EXPECT_EQ(save(mapper_part(2), {"kitchen", "id2", {kTracker, kMapper}}), SaveState::kWaits);
  EXPECT_THAT(names(), ElementsAre(".saving"));
  // Somebody puts a part of one save to the other.
  fs::rename(maps / ".saving/kitchen.id1/tracker.rds", maps / ".saving/kitchen.id2/tracker.rds");
  const auto mixed = save({kLoopCloser, {{kLoopCloser, {2}}}, {}}, {"kitchen", "id2", {kTracker, kMapper, kLoopCloser}});
  ASSERT_FALSE(mixed);
  EXPECT_THAT(mixed.error(), HasSubstr("tracker.rds: is a part of another save"));
  EXPECT_FALSE(fs::exists(maps / "kitchen"));
}

TEST_F(JointSave, OfServicesThatFinishAtTheSameTimeOnePublishes) {
  for (int i = 0; i < 10; ++i) {
    const SaveOrder order{"kitchen", "id" + std::to_string(i), {kTracker, kMapper}};
    tl::expected<SaveState, std::string> of_tracker;
    std::thread tracker([&] { of_tracker = save(tracker_part(1), order); });
    const auto of_mapper = save(mapper_part(1), order);
    tracker.join();
    ASSERT_TRUE(of_tracker && of_mapper);
    EXPECT_EQ((*of_tracker == SaveState::kPublished) + (*of_mapper == SaveState::kPublished), 1);
    EXPECT_EQ(saved(), whole(1));
    fs::remove_all(maps / "kitchen");
  }
}

TEST_F(JointSave, LeavesTheEarlierMapWhenThereIsNoRoom) {
  (void)save(tracker_part(1));
  (void)save(mapper_part(1));
  const SaveOrder next{"kitchen", "id2", {kTracker, kMapper}};
  EXPECT_EQ(save(tracker_part(2), next), SaveState::kWaits);
  {
    const test::FileSizeLimit limit(150);
    const auto full = save(mapper_part(2), next);
    ASSERT_FALSE(full);
    EXPECT_THAT(full.error(), HasSubstr("cannot be written: File too large"));
  }
  EXPECT_EQ(saved(), whole(1));
  EXPECT_THAT(names(".saving"), IsEmpty());
}

TEST_F(JointSave, RefusesADamagedPart) {
  EXPECT_EQ(save(tracker_part()), SaveState::kWaits);
  const fs::path part = maps / ".saving/kitchen.id1/tracker.rds";
  std::string bytes = test::read_text(part);
  bytes.back() = static_cast<char>(~bytes.back());
  test::write_text(part, bytes);
  EXPECT_THAT(save(mapper_part()).error(), HasSubstr("tracker.rds: is damaged"));
  EXPECT_FALSE(fs::exists(maps / "kitchen"));
}

TEST_F(JointSave, WritesThroughNoLink) {
  const test::TemporaryFolder outside;
  fs::create_symlink(outside.path(), maps / ".saving");
  EXPECT_THAT(save(tracker_part()).error(), HasSubstr(".saving: cannot be opened"));
  fs::remove(maps / ".saving");
  fs::create_directory(maps / ".saving");
  fs::create_symlink(outside.path(), maps / ".saving/kitchen.id1");
  EXPECT_THAT(save(tracker_part()).error(), HasSubstr("kitchen.id1: cannot be opened"));
  fs::create_symlink(outside.path(), maps / "kitchen");
  EXPECT_THAT(save(tracker_part(), {"kitchen", "id2", {kTracker}}).error(), HasSubstr("holds what is no map"));
  EXPECT_TRUE(fs::is_empty(outside.path()));
}

TEST_F(JointSave, ReplacesNoFolderThatIsNoMap) {
  test::write_text(maps / "kitchen" / "thesis.tex", "precious");
  EXPECT_THAT(save(tracker_part(), {"kitchen", "id1", {kTracker}}).error(), HasSubstr("holds what is no map"));
  EXPECT_EQ(test::read_text(maps / "kitchen" / "thesis.tex"), "precious");
}

TEST_F(JointSave, RemovesSavesThatWereNeverCompleted) {
  for (const char* id : {"old", "future", "new"}) (void)save(tracker_part(), {"kitchen", id, {kTracker, kMapper}});
  const auto now = fs::file_time_type::clock::now();
  fs::last_write_time(maps / ".saving/kitchen.old", now - std::chrono::minutes(11));
  fs::last_write_time(maps / ".saving/kitchen.future", now + std::chrono::hours(1000));
  EXPECT_EQ(save(tracker_part()), SaveState::kWaits);
  EXPECT_THAT(names(".saving"), ElementsAre("kitchen.id1", "kitchen.new"));
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(save(tracker_part(), {"kitchen", std::to_string(i), {kTracker, kMapper}}), SaveState::kWaits);
  EXPECT_EQ(names(".saving").size(), 8U);
}

TEST_F(JointSave, ASecondPartOfTheSameServiceIsRefused) {
  EXPECT_EQ(save(tracker_part(1)), SaveState::kWaits);
  EXPECT_THAT(save(tracker_part(2)).error(), HasSubstr("is there already"));
  EXPECT_EQ(save(mapper_part(1)), SaveState::kPublished);
  EXPECT_EQ(saved(), whole(1));
}

TEST_F(JointSave, RefusesOrdersThatAreImpossible) {
  for (const SaveOrder& order : std::vector<SaveOrder>{{"../kitchen", "id", {kTracker}},
                                                       {"kitchen", "", {kTracker}},
                                                       {"kitchen", "a.b", {kTracker}},
                                                       {"kitchen", "../x", {kTracker}},
                                                       {"kitchen", "id", {}},
                                                       {"kitchen", "id", {kTracker, kTracker}},
                                                       {"kitchen", "id", {"detector"}}})
    EXPECT_FALSE(save(tracker_part(), order)) << order.name << " " << order.id;
  EXPECT_THAT(names(), IsEmpty());
}

}  // namespace
}  // namespace rds::map_file
