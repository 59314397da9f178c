// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/saved_map.hpp"

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.hpp"

namespace rds::map_file {
namespace {

using ::testing::HasSubstr;

class SavedMap : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(
        write_map_file(service_file(place_.path(), kTracker), {{kTracker, {1}}, {kKeyframePoses, {2}}}));
    ASSERT_TRUE(write_map_file(service_file(place_.path(), kMapper), {{kMapper, {3}}}));
  }
  test::TemporaryFolder place_;
};

TEST_F(SavedMap, ServicesFilesBecomeOne) {
  ASSERT_TRUE(merge_service_files(place_.path(), place_ / kMapFile));
  const auto merged = read_saved_map(place_ / kMapFile);
  ASSERT_TRUE(merged) << merged.error();
  EXPECT_EQ(*merged, (Sections{{kTracker, {1}}, {kKeyframePoses, {2}}, {kMapper, {3}}}));
  EXPECT_FALSE(exists(service_file(place_.path(), kTracker)));
}

TEST_F(SavedMap, IsFoundInTheFolderOfARunAndOfACommand) {
  const auto of_command = read_saved_map(place_.path());
  ASSERT_TRUE(of_command) << of_command.error();
  ASSERT_TRUE(merge_service_files(place_.path(), place_ / kMapFile));
  EXPECT_EQ(*read_saved_map(place_.path()), *of_command);
}

TEST_F(SavedMap, SaysWhatIsMissing) {
  const auto read = read_saved_map(place_.path(), {kTracker, kLoopCloser});
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error(), HasSubstr("no section 'loop_closer'"));
  const test::TemporaryFolder empty;
  EXPECT_THAT(read_saved_map(empty.path()).error(), HasSubstr("holds no saved map, expected map.rds"));
}

TEST_F(SavedMap, ADamagedServiceFileIsNamed) {
  test::write_text(service_file(place_.path(), kMapper), "torn");
  const auto merged = merge_service_files(place_.path(), place_ / kMapFile);
  ASSERT_FALSE(merged);
  EXPECT_THAT(merged.error(), HasSubstr("mapper.rds"));
  EXPECT_FALSE(exists(place_ / kMapFile));
}

}  // namespace
}  // namespace rds::map_file
