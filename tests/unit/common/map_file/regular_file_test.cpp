// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/regular_file.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "common/map_file/atomic_file.hpp"
#include "common/map_file/map_file.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::map_file {
namespace {

using ::testing::HasSubstr;

std::string fault_of(const std::filesystem::path& file, const FileLimits& limits = {}) {
  const auto read = read_regular_file(file, limits);
  return read ? "" : read.error();
}

TEST(RegularFile, IsReadToItsEnd) {
  const test::TemporaryFolder place;
  const std::string text(3'000'000, 'x');
  test::write_text(place / "file", text);
  const auto read = read_regular_file(place / "file");
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(std::string(read->begin(), read->end()), text);
  EXPECT_EQ(start_of_file(place / "file", 4), "xxxx");
}

TEST(RegularFile, DevicesPipesAndFoldersAreRefusedAndNotReadFrom) {
  const test::TemporaryFolder place;
  ASSERT_EQ(mkfifo((place / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(fault_of("/dev/zero"), "is no regular file");
  EXPECT_EQ(fault_of(place / "pipe"), "is no regular file");
  EXPECT_EQ(fault_of(place.path()), "is a folder, expected a file");
  EXPECT_EQ(fault_of(place / "none"), "No such file or directory");
  EXPECT_EQ(start_of_file("/dev/zero", 4), "");
  EXPECT_EQ(start_of_file(place / "pipe", 4), "");
}

TEST(RegularFile, IsRefusedBeforeMemoryIsTakenIfItIsTooLarge) {
  const test::TemporaryFolder place;
  std::ofstream(place / "file").seekp(1LL << 40).put('x');  // of holes
  EXPECT_THAT(fault_of(place / "file"), HasSubstr("has 1099511627777 bytes, expected at most 4294967296"));
  EXPECT_THAT(fault_of(place / "file", {.max_bytes = 10}), HasSubstr("expected at most 10"));
}

TEST(RegularFile, IsGivenUpAtTheDeadlineAndAtAStop) {
  const test::TemporaryFolder place;
  test::write_text(place / "file", "text");
  EXPECT_EQ(fault_of(place / "file", {.deadline = std::chrono::steady_clock::now()}), "not done in time");
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(fault_of(place / "file", {.stop = stop.get_token()}), "broken off");
}

TEST(RegularFile, AMapFileIsOne) {
  const test::TemporaryFolder place;
  ASSERT_EQ(mkfifo((place / "map.rds").c_str(), 0600), 0);
  EXPECT_THAT(read_map_file(place / "map.rds").error(), HasSubstr("is no regular file"));
  EXPECT_THAT(read_map_file("/dev/zero").error(), HasSubstr("is no regular file"));
}

TEST(AtomicFile, NeverWritesThroughALinkThatLiesWhereItWrites) {
  const test::TemporaryFolder place;
  test::write_text(place / "precious", "text");
  std::filesystem::create_symlink(place / "precious", place / ("file.partial-" + std::to_string(getpid())));
  std::filesystem::create_symlink(place / "precious", place / "file");
  ASSERT_TRUE(write_atomically(place / "file", std::string("new")));
  EXPECT_EQ(test::read_text(place / "precious"), "text");
  EXPECT_EQ(test::read_text(place / "file"), "new");
}

TEST(AtomicFile, SaysThatTheDiskIsFullAndLeavesTheOldFile) {
  const test::TemporaryFolder place;
  test::write_text(place / "file", "old");
  const test::FileSizeLimit limit(3);
  const auto written = write_atomically(place / "file", std::string("longer"));
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error(), HasSubstr("file: cannot be written: File too large"));
  EXPECT_EQ(test::read_text(place / "file"), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(place.path()), {}), 1);
}

}  // namespace
}  // namespace rds::map_file
