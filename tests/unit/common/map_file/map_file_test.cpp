// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/map_file.hpp"

#include <fstream>

#include <gmock/gmock.h>

#include "common/map_file/atomic_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::map_file {
namespace {

using ::testing::HasSubstr;

const Sections kSections{{"mapper", Bytes(300, 7)}, {"tracker", {1, 2, 3}}, {"empty", {}}};

void write_bytes(const std::filesystem::path& file, const Bytes& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

TEST(MapFile, ComesBackAsItWasWritten) {
  const test::TemporaryFolder place;
  ASSERT_TRUE(write_atomically(place / "map.rds", to_bytes(kSections)));
  const auto read = read_map_file(place / "map.rds");
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(*read, kSections);
}

TEST(MapFile, SameSectionsGiveTheSameBytes) {
  EXPECT_EQ(to_bytes(kSections), to_bytes(kSections));
}

TEST(MapFile, EveryTornFileIsRefused) {
  const Bytes whole = to_bytes(kSections);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(sections_from_bytes(std::span(whole).first(size))) << size;
  Bytes longer = whole;
  longer.push_back(0);
  EXPECT_FALSE(sections_from_bytes(longer));
}

TEST(MapFile, EveryAlteredByteIsNoticed) {
  const Bytes whole = to_bytes(kSections);
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const int bit : {0, 7}) {
      Bytes altered = whole;
      altered[at] = static_cast<std::uint8_t>(altered[at] ^ (1 << bit));
      EXPECT_FALSE(sections_from_bytes(altered)) << at;
    }
}

TEST(MapFile, SaysWhichFileAndWhatWasExpected) {
  const test::TemporaryFolder place;
  const auto file = place / "map.rds";
  const auto fault = [&] { return read_map_file(file).error(); };
  EXPECT_THAT(fault(),
              testing::AllOf(HasSubstr(file.string()), HasSubstr("cannot be read, expected a saved map")));
  test::write_text(file, "# Octomap OcTree file");
  EXPECT_THAT(fault(), testing::AllOf(HasSubstr(file.string()), HasSubstr("is not a saved map, expected")));
  Bytes bytes = to_bytes(kSections);
  bytes[8] = 1;
  write_bytes(file, bytes);
  EXPECT_THAT(fault(), HasSubstr("has format version 1, expected 4"));
  bytes = to_bytes(kSections);
  bytes.pop_back();
  write_bytes(file, bytes);
  EXPECT_THAT(fault(), HasSubstr("is torn"));
  bytes = to_bytes(kSections);
  bytes.back() ^= 1U;
  write_bytes(file, bytes);
  EXPECT_THAT(fault(), HasSubstr("section 'tracker' has another checksum"));
}

TEST(MapFile, LeavesTheOldFileWhenItCannotBeWritten) {
  const test::TemporaryFolder place;
  test::write_text(place / "map.rds/occupied", "a folder in the way");
  const auto written = write_atomically(place / "map.rds", to_bytes(kSections));
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error(), HasSubstr("map.rds: cannot be written"));
  EXPECT_TRUE(exists(place / "map.rds/occupied"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(place.path()), {}), 1)
      << "no partial file is left";
}

}  // namespace
}  // namespace rds::map_file
