// SPDX-License-Identifier: Apache-2.0
#include "common/store/maps_folder.hpp"

#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/support/temporary_folder.hpp"

namespace rds::store {
namespace {

using ::testing::HasSubstr;

class MapsFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* variable : {"RDS_MAPS_DIR", "XDG_DATA_HOME"}) ::unsetenv(variable);
    ::setenv("HOME", "/home/robot", 1);
  }
};

TEST_F(MapsFolder, IsTheSettingsThenTheEnvironments) {
  EXPECT_EQ(maps_folder({}), "/home/robot/.local/share/rds-slam/maps");
  ::setenv("XDG_DATA_HOME", "/data", 1);
  EXPECT_EQ(maps_folder({}), "/data/rds-slam/maps");
  ::setenv("RDS_MAPS_DIR", "/maps", 1);
  EXPECT_EQ(maps_folder({}), "/maps");
  EXPECT_EQ(maps_folder({.maps_dir = "/elsewhere"}), "/elsewhere");
}

TEST_F(MapsFolder, RelativePathsOfTheEnvironmentAreNotUsed) {
  ::setenv("XDG_DATA_HOME", "data", 1);
  EXPECT_EQ(maps_folder({}), "/home/robot/.local/share/rds-slam/maps");
  ::unsetenv("HOME");
  EXPECT_THAT(maps_folder({}).error(), HasSubstr("maps_dir"));
}

TEST(MakePrivateFolder, IsForItsOwnerAlone) {
  const test::TemporaryFolder place;
  ASSERT_TRUE(make_private_folder(place / "a" / "b"));
  struct ::stat status {};
  for (const auto& folder : {place / "a", place / "a" / "b"}) {
    ASSERT_EQ(::stat(folder.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0700U) << folder;
  }
}

TEST(MakePrivateFolder, NamesWhatIsInTheWay) {
  const test::TemporaryFolder place;
  std::ofstream(place / "file") << "x";
  EXPECT_THAT(make_private_folder(place / "file" / "b").error(), HasSubstr((place / "file").string()));
}

TEST(CheckpointFile, IsOnePerServiceAndDomain) {
  EXPECT_EQ(checkpoint_file("/maps", 7, "/", "mapper"), "/maps/checkpoints/domain-7/mapper.db");
  EXPECT_EQ(checkpoint_file("/maps", 7, "/a/robot1", "mapper"), "/maps/checkpoints/domain-7/a/robot1/mapper.db");
}

}  // namespace
}  // namespace rds::store
