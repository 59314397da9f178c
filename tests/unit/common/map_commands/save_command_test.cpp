// SPDX-License-Identifier: Apache-2.0
#include "common/map_commands/save_command.hpp"

#include <gmock/gmock.h>

namespace rds::map_commands {
namespace {

using map_file::SaveOrder;
using ::testing::HasSubstr;

tl::expected<SaveOrder, std::string> parse(const std::string& argument, bool to_all = false) {
  return parse_save({"save", argument, {}, 0xABC, to_all}, "mapper");
}

TEST(SaveCommand, ANameMeansTheServiceThatWasAskedOrAll) {
  EXPECT_EQ(*parse("kitchen"), (SaveOrder{"kitchen", "0000000000000abc", {"mapper"}}));
  EXPECT_EQ(*parse("kitchen", true),
            (SaveOrder{"kitchen", "0000000000000abc", {"tracker", "mapper", "loop_closer"}}));
}

TEST(SaveCommand, JsonNamesIdAndParts) {
  EXPECT_EQ(*parse(R"({"name": "kitchen", "id": "x1", "parts": ["tracker", "mapper"]})"),
            (SaveOrder{"kitchen", "x1", {"tracker", "mapper"}}));
}

TEST(SaveCommand, WhatIsNoOrderIsRefusedWithASentence) {
  EXPECT_THAT(parse("/tmp/map").error(), HasSubstr("not the name of a map"));
  EXPECT_THAT(parse("").error(), HasSubstr("not the name of a map"));
  for (const char* text : {"{", "{}", R"({"name": 1, "id": "x", "parts": []})", "{\"name\": \"\xFF\"}",
                           R"({"name": "kitchen", "id": "x", "parts": "mapper"})"})
    EXPECT_THAT(parse(text).error(), HasSubstr("not a save, expected the name of a map")) << text;
  EXPECT_THAT(parse(R"({"name": "kitchen", "id": "x", "parts": ["tracker"]})").error(),
              HasSubstr("'mapper' is none of the parts"));
  EXPECT_THAT(parse(R"({"name": "kitchen", "id": "../x", "parts": ["mapper"]})").error(),
              HasSubstr("not the id of a save"));
}

}  // namespace
}  // namespace rds::map_commands
