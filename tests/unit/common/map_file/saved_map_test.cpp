// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/saved_map.hpp"

#include <gmock/gmock.h>

#include "common/map_file/atomic_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::map_file {
namespace {

using ::testing::HasSubstr;

class SavedMap : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(write_atomically(place_ / kMapFile, to_bytes(all_))); }
  const Sections all_{{kTracker, {1}}, {kKeyframePoses, {2}}, {kMapper, {3}}};
  test::TemporaryFolder place_;
};

TEST_F(SavedMap, IsFoundByItsFileAndInItsFolder) {
  EXPECT_EQ(*read_saved_map(place_ / kMapFile), all_);
  EXPECT_EQ(*read_saved_map(place_.path()), all_);
  EXPECT_EQ(*read_saved_map(*Folder::open(place_.path()), {kMapper}, {}), all_);
}

TEST_F(SavedMap, SaysWhatIsMissing) {
  for (const auto& read : {read_saved_map(place_.path(), {kTracker, kLoopCloser}),
                           read_saved_map(*Folder::open(place_.path()), {kTracker, kLoopCloser}, {})}) {
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error(), HasSubstr("no section 'loop_closer'"));
  }
  const test::TemporaryFolder empty;
  EXPECT_THAT(read_saved_map(empty.path()).error(), HasSubstr("holds no saved map, expected map.rds"));
}

TEST_F(SavedMap, IsNoLink) {
  std::filesystem::rename(place_ / kMapFile, place_ / "elsewhere.rds");
  std::filesystem::create_symlink(place_ / "elsewhere.rds", place_ / kMapFile);
  EXPECT_TRUE(read_saved_map(place_.path())) << "whoever names a path may use links";
  EXPECT_THAT(read_saved_map(*Folder::open(place_.path()), {}, {}).error(), HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace rds::map_file
