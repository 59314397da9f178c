// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/folder.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "common/map_file/replace_folder.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::map_file {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Content = std::vector<std::uint8_t>;

class FolderTest : public ::testing::Test {
 protected:
  test::TemporaryFolder place;
  Folder folder = *Folder::open(place.path());
};

TEST_F(FolderTest, ReadsWhatItWroteEvenWhenItWasRenamed) {
  const auto inner = folder.make("inner");
  ASSERT_TRUE(inner) << inner.error();
  fs::rename(place / "inner", place / "moved");
  ASSERT_TRUE(inner->write("file", Content{1, 2}, {}));
  EXPECT_EQ(*inner->read("file", {}), (Content{1, 2}));
  EXPECT_TRUE(fs::exists(place / "moved" / "file"));
  EXPECT_TRUE(inner->has_file("file"));
  EXPECT_FALSE(inner->has_file("none"));
  EXPECT_EQ(fs::status(place / "moved").permissions(), fs::perms::owner_all);
  EXPECT_THAT(inner->names(), ElementsAre("file"));
}

TEST_F(FolderTest, FollowsNoLinks) {
  test::write_text(place / "outside" / "file", "text");
  fs::create_symlink(place / "outside", place / "link");
  fs::create_symlink(place / "outside" / "file", place / "file");
  EXPECT_THAT(folder.enter("link").error(), HasSubstr("cannot be opened"));
  EXPECT_THAT(folder.make("link").error(), HasSubstr("cannot be opened"));
  EXPECT_THAT(folder.read("file", {}).error(), HasSubstr("cannot be read"));
  EXPECT_FALSE(folder.has_file("file"));
  EXPECT_THAT(folder.write("file", Content{1}, {}).error(), HasSubstr("cannot be written: File exists"));
  EXPECT_EQ(test::read_text(place / "outside" / "file"), "text");
}

TEST_F(FolderTest, WritesNothingInPlaceOfAnotherFile) {
  ASSERT_TRUE(folder.write("file", Content{1}, {}));
  EXPECT_THAT(folder.write("file", Content{2}, {}).error(), HasSubstr("File exists"));
  EXPECT_EQ(*folder.read("file", {}), Content{1});
  EXPECT_THAT(folder.names(), ElementsAre("file"));
}

TEST_F(FolderTest, LeavesNothingOfAFileThatHasNoRoom) {
  const test::FileSizeLimit limit(10);
  EXPECT_THAT(folder.write("file", Content(100), {}).error(), HasSubstr("file: cannot be written"));
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST_F(FolderTest, RemovesFoldersButNotWhatLinksInThemPointAt) {
  test::write_text(place / "outside" / "file", "text");
  test::write_text(place / "inner" / "deep" / "file", "text");
  fs::create_symlink(place / "outside", place / "inner" / "link");
  folder.remove("inner");
  folder.remove("none");
  EXPECT_THAT(folder.names(), ElementsAre("outside"));
  EXPECT_EQ(test::read_text(place / "outside" / "file"), "text");
}

TEST_F(FolderTest, TakesThePlaceOfAnother) {
  test::write_text(place / "old" / "file", "old");
  test::write_text(place / "new" / "file", "new");
  const auto replaced = replace_folder(AT_FDCWD, place / "new", AT_FDCWD, place / "old");
  ASSERT_TRUE(replaced) << replaced.error();
  EXPECT_TRUE(*replaced);
  EXPECT_EQ(test::read_text(place / "old" / "file"), "new");
  EXPECT_EQ(test::read_text(place / "new" / "file"), "old");
  EXPECT_FALSE(*replace_folder(folder.number(), "new", folder.number(), "elsewhere"));
  EXPECT_EQ(test::read_text(place / "elsewhere" / "file"), "old");
  EXPECT_FALSE(replace_folder(AT_FDCWD, place / "none", AT_FDCWD, place / "old"));
  EXPECT_EQ(test::read_text(place / "old" / "file"), "new");
}

}  // namespace
}  // namespace rds::map_file
