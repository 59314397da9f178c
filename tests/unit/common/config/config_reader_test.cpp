// SPDX-License-Identifier: Apache-2.0
#include "common/config/config_reader.hpp"

#include <gmock/gmock.h>

namespace rds::config {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

ConfigReader reader(const std::string& yaml) {
  return {YAML::Load(yaml), "test.yaml"};
}

TEST(ConfigReader, KeepsDefaultsOfAbsentKeysAndTakesPresentOnes) {
  int size = 3;
  double range = 4;
  auto r = reader("section: {range: 2.5}");
  r.value("size", size, 1, 10, "px");
  r.section("section").value("range", range, 0.0, 5.0, "m");
  r.finish();
  EXPECT_EQ(size, 3);
  EXPECT_EQ(range, 2.5);
}

TEST(ConfigReader, ListsAllViolationsAtOnce) {
  int size = 3;
  double range = 4;
  std::string mode = "fast";
  auto r = reader("{size: 99, section: {range: far, colour: red}, mode: slow, typo: 1}");
  r.value("size", size, 1, 10, "px");
  r.choice("mode", mode, {"fast", "exact"});
  r.section("section").value("range", range, 0.0, 5.0, "m");
  try {
    r.finish();
    FAIL() << "no violation found";
  } catch (const ConfigError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("size: 99, expected 1 … 10 px"), HasSubstr("mode: slow"),
                                HasSubstr("section.range: far"), HasSubstr("section.colour: unknown key"),
                                HasSubstr("typo: unknown key")));
  }
  EXPECT_EQ(size, 3);
}

TEST(ConfigReader, KnowsWhichKeysAreAbsent) {
  ConfigReader reader(YAML::Load("{a: 1, s: {b: 1}}"), "test.yaml");
  int value = 0;
  for (const char* key : {"a", "c"}) reader.value(key, value, 0, 9);
  for (const char* key : {"b", "d"}) reader.section("s").value(key, value, 0, 9);
  reader.section("t").value("e", value, 0, 9);
  EXPECT_THAT(reader.absent(), ::testing::UnorderedElementsAre("c", "s.d", "t", "t.e"));
}

TEST(ConfigReader, NamesTheMissingFile) {
  EXPECT_THROW(ConfigReader::from_file("/nonexistent/x.yaml"), ConfigError);
}

}  // namespace
}  // namespace rds::config
