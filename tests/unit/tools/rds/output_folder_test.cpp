// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/output/output_folder.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace rds::run {
namespace {

using test::TemporaryFolder;
using test::write_text;

TEST(OutputFolder, TakesItsNameOnlyWhenPublished) {
  const TemporaryFolder place;
  OutputFolder folder(place / "out", false);
  write_text(folder.path() / "summary.json", "{}");
  EXPECT_FALSE(exists(place / "out"));
  folder.publish();
  EXPECT_TRUE(exists(place / "out" / "summary.json"));
}

TEST(OutputFolder, LeavesNothingBehindWhenNotPublished) {
  const TemporaryFolder place;
  { const OutputFolder folder(place / "out", false); }
  EXPECT_TRUE(is_empty(place.path()));
}

TEST(OutputFolder, OverwritesAnEarlierRunOnlyWhenForced) {
  const TemporaryFolder place;
  write_text(place / "out" / "summary.json", "old");
  EXPECT_THROW(OutputFolder(place / "out", false), std::runtime_error);
  OutputFolder folder(place / "out", true);
  EXPECT_EQ(test::read_text(place / "out" / "summary.json"), "old");
  write_text(folder.path() / "summary.json", "new");
  folder.publish();
  EXPECT_EQ(test::read_text(place / "out" / "summary.json"), "new");
}

TEST(OutputFolder, LeavesTheEarlierRunWhenItCannotBePublished) {
  const TemporaryFolder place;
  write_text(place / "out" / "summary.json", "old");
  OutputFolder folder(place / "out", true);
  remove_all(folder.path());
  EXPECT_THROW(folder.publish(), std::runtime_error);
  EXPECT_EQ(test::read_text(place / "out" / "summary.json"), "old");
}

TEST(OutputFolder, LeavesNothingOfTheEarlierRunWhenItIsPublished) {
  const TemporaryFolder place;
  write_text(place / "out" / "summary.json", "old");
  write_text(place / "out" / "overlay" / "000000.jpg", "old");
  OutputFolder folder(place / "out", true);
  write_text(folder.path() / "summary.json", "new");
  folder.publish();
  EXPECT_FALSE(exists(place / "out" / "overlay"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(place.path()), {}), 1);
}

TEST(OutputFolder, NeverReplacesAFolderThatIsNoRun) {
  const TemporaryFolder place;
  write_text(place / "out" / "thesis.tex", "precious");
  EXPECT_THROW(OutputFolder(place / "out", true), std::runtime_error);
  EXPECT_TRUE(exists(place / "out" / "thesis.tex"));
}

TEST(OutputFolder, SaysWhenTheParentIsAFile) {
  const TemporaryFolder place;
  write_text(place / "file", "");
  EXPECT_THROW(OutputFolder(place / "file" / "out", false), std::runtime_error);
}

}  // namespace
}  // namespace rds::run
