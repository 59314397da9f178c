// SPDX-License-Identifier: Apache-2.0
#include "common/service/ros/parameter_table.hpp"

#include <gmock/gmock.h>

#include "common/service/ros/setting_comments.hpp"

namespace rds::service {
namespace {

using enum ParameterKind;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

constexpr const char* kShipped = R"(# Settings.
nice: 10               # 0 to 19: gives way
enabled: true          # or not
name: ""               # "quoted" # and more
camera:  # of the robot
  color: camera/color  # a topic
  depth:
    max_m: 8.0         # beyond: as if not measured
axis: []
origins: [a#b, c]      # sites
)";

ParameterTable table(const std::string& given = "{}") {
  return {kShipped, YAML::Load(given), {"camera.depth.max_m", "name"}};
}

rcl_interfaces::msg::Parameter wanted(const std::string& name, ParameterKind kind) {
  rcl_interfaces::msg::Parameter parameter;
  parameter.name(name);
  parameter.value().type(static_cast<std::uint8_t>(kind));
  parameter.value().integer_value(3);
  parameter.value().double_value(2.5);
  parameter.value().string_value("no: \"yes\"");
  return parameter;
}

rcl_interfaces::msg::ParameterValue value(const ParameterTable& table, const std::string& name) {
  return table.values({name}).at(0);
}

ParameterKind kind(const ParameterTable& table, const std::string& name) {
  return static_cast<ParameterKind>(table.kinds({name}).at(0));
}

TEST(SettingComments, AreThoseBehindTheSettings) {
  EXPECT_THAT(setting_comments(kShipped),
              UnorderedElementsAre(Pair("nice", "0 to 19: gives way"), Pair("enabled", "or not"),
                                   Pair("name", "\"quoted\" # and more"), Pair("camera.color", "a topic"),
                                   Pair("camera.depth.max_m", "beyond: as if not measured"),
                                   Pair("origins", "sites")));
}

TEST(ParameterTable, HasEverySettingWithItsDefault) {
  const ParameterTable parameters = table();
  EXPECT_EQ(value(parameters, "nice").integer_value(), 10);
  EXPECT_TRUE(value(parameters, "enabled").bool_value());
  EXPECT_EQ(value(parameters, "name").string_value(), "");
  EXPECT_EQ(kind(parameters, "name"), kString);
  EXPECT_EQ(value(parameters, "camera.color").string_value(), "camera/color");
  EXPECT_EQ(value(parameters, "camera.depth.max_m").double_value(), 8.0);
  EXPECT_EQ(kind(parameters, "axis"), kStringArray);
  EXPECT_THAT(value(parameters, "origins").string_array_value(), ElementsAre("a#b", "c"));
}

TEST(ParameterTable, TakesWhatWasSetInTheKindOfTheDefault) {
  const ParameterTable parameters =
      table("{nice: 3, name: off, camera: {depth: {max_m: 2}}, axis: [0, -1.5, 0], enabled: no}");
  EXPECT_EQ(value(parameters, "nice").integer_value(), 3);
  EXPECT_EQ(value(parameters, "name").string_value(), "off");
  EXPECT_EQ(value(parameters, "camera.depth.max_m").double_value(), 2.0);
  EXPECT_EQ(kind(parameters, "camera.depth.max_m"), kDouble);
  EXPECT_THAT(value(parameters, "axis").double_array_value(), ElementsAre(0, -1.5, 0));
  EXPECT_EQ(kind(parameters, "enabled"), kBool);
  EXPECT_EQ(value(parameters, "camera.color").string_value(), "camera/color");
}

TEST(ParameterTable, ListsBelowPrefixesAsDeepAsAsked) {
  const ParameterTable parameters = table();
  EXPECT_THAT(parameters.list({}, 0).names(), ElementsAre("axis", "camera.color", "camera.depth.max_m",
                                                          "enabled", "name", "nice", "origins"));
  EXPECT_THAT(parameters.list({}, 0).prefixes(), ElementsAre("camera", "camera.depth"));
  EXPECT_THAT(parameters.list({}, 1).names(), ElementsAre("axis", "enabled", "name", "nice", "origins"));
  EXPECT_THAT(parameters.list({"camera"}, 1).names(), ElementsAre("camera.color"));
  EXPECT_THAT(parameters.list({"camera"}, 0).names(), ElementsAre("camera.color", "camera.depth.max_m"));
  EXPECT_THAT(parameters.list({"nice", "cam"}, 0).names(), ElementsAre("nice"));
}

TEST(ParameterTable, KnowsNothingOfOthers) {
  const ParameterTable parameters = table();
  EXPECT_EQ(kind(parameters, "other"), kNotSet);
  EXPECT_THAT(parameters.list({"other"}, 0).names(), IsEmpty());
  EXPECT_EQ(parameters.descriptors({"other"}).at(0).name(), "other");
  EXPECT_THAT(parameters.changes({wanted("other", kInteger)}).error(), HasSubstr("not a setting"));
}

TEST(ParameterTable, DescribesAndRefuses) {
  const ParameterTable parameters = table();
  const auto descriptor = parameters.descriptors({"camera.depth.max_m"}).at(0);
  EXPECT_EQ(descriptor.description(), "beyond: as if not measured");
  EXPECT_EQ(static_cast<ParameterKind>(descriptor.type()), kDouble);
  EXPECT_FALSE(descriptor.read_only());
  EXPECT_TRUE(parameters.descriptors({"nice"}).at(0).read_only());
  EXPECT_THAT(parameters.changes({wanted("nice", kInteger)}).error(), HasSubstr("-p nice:=VALUE"));
  EXPECT_THAT(parameters.changes({wanted("name", kString), wanted("nice", kInteger)}).error(),
              HasSubstr("read at the start"));
}

TEST(ParameterTable, TakesLiveSettingsOfTheirKind) {
  const ParameterTable parameters = table();
  const auto of_doubles = parameters.changes({wanted("camera.depth.max_m", kDouble)});
  EXPECT_EQ(YAML::Load(of_doubles.value())["camera.depth.max_m"].as<double>(), 2.5);
  const auto of_integers =
      parameters.changes({wanted("camera.depth.max_m", kInteger), wanted("name", kString)});
  EXPECT_EQ(YAML::Load(of_integers.value())["camera.depth.max_m"].as<double>(), 3);
  EXPECT_EQ(YAML::Load(of_integers.value())["name"].as<std::string>(), "no: \"yes\"");
  EXPECT_EQ(parameters.changes({wanted("name", kBool)}).error(), "'name' is of type string, not boolean");
  EXPECT_EQ(parameters.changes({wanted("name", kNotSet)}).error(), "'name' is of type string, not none");
}

TEST(ParameterTable, TellsWhatWasSet) {
  ParameterTable parameters = table();
  EXPECT_EQ(parameters.set("camera.depth.max_m", YAML::Load("3")).double_value(), 3);
  EXPECT_EQ(value(parameters, "camera.depth.max_m").double_value(), 3);
  EXPECT_EQ(kind(parameters, "camera.depth.max_m"), kDouble);
}

}  // namespace
}  // namespace rds::service
