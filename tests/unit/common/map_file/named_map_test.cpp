// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/named_map.hpp"

#include <gmock/gmock.h>

#include "common/map_file/atomic_file.hpp"
#include "common/map_file/saved_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::map_file {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(MapName, IsNoPath) {
  for (const char* name : {"kitchen", "a", "-1", "_x", "Hall.2026-11-23_b"}) EXPECT_TRUE(check_map_name(name)) << name;
  EXPECT_TRUE(check_map_name(std::string(64, 'a')));
  for (const char* name : {"", ".", "..", ".saving", "/tmp/map", "a/b", "a b", "../map", "checkpoints", "k\xC3\xBC" "che",
                           "a\n", "~", "map*"})
    EXPECT_FALSE(check_map_name(name)) << name;
  EXPECT_FALSE(check_map_name(std::string(65, 'a')));
  EXPECT_FALSE(check_map_name(std::string_view("a\0b", 3)));
  EXPECT_THAT(check_map_name("/dev/zero").error(), HasSubstr("not the name of a map, expected"));
}

class NamedMap : public ::testing::Test {
 protected:
  test::TemporaryFolder maps;
};

TEST_F(NamedMap, IsOpenedBelowTheFolderOfMapsAndNeverThroughALink) {
  test::write_text(maps / "kitchen" / "map.rds", "");
  fs::create_symlink(maps / "kitchen", maps / "link");
  EXPECT_TRUE(open_map(maps.path(), "kitchen"));
  EXPECT_THAT(open_map(maps.path(), "link").error(), HasSubstr("link: cannot be opened"));
  EXPECT_THAT(open_map(maps.path(), "none").error(), HasSubstr("none: cannot be opened"));
  EXPECT_THAT(open_map(maps.path(), "..").error(), HasSubstr("not the name of a map"));
  EXPECT_THAT(open_map(maps / "nowhere", "kitchen").error(), HasSubstr("nowhere: cannot be opened"));
}

TEST_F(NamedMap, AreListedByNameWithTheirParts) {
  fs::create_directories(maps / "kitchen");
  ASSERT_TRUE(write_atomically(maps / "kitchen" / kMapFile, to_bytes(Sections{{kTracker, {1}}, {kMapper, {2}}, {kKeyframePoses, {}}})));
  test::write_text(maps / "broken" / kMapFile, "broken");
  test::write_text(maps / "checkpoints" / kMapFile, "");
  test::write_text(maps / "no_map" / "file", "");
  test::write_text(maps / "file", "");
  const auto all = list_maps(maps.path());
  ASSERT_TRUE(all) << all.error();
  ASSERT_EQ(all->size(), 2U);
  EXPECT_EQ(all->at(0).name, "broken");
  EXPECT_THAT(all->at(0).parts, IsEmpty());
  EXPECT_EQ(all->at(0).bytes, 6U);
  EXPECT_EQ(all->at(1).name, "kitchen");
  EXPECT_THAT(all->at(1).parts, ElementsAre(kTracker, kMapper));
  EXPECT_GT(all->at(1).saved_s, 0);
  EXPECT_THAT(list_maps(maps / "nowhere").error(), HasSubstr("nowhere"));
}

}  // namespace
}  // namespace rds::map_file
