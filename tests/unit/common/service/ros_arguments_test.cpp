// SPDX-License-Identifier: Apache-2.0
#include "common/service/ros/ros_arguments.hpp"

#include <fstream>

#include <gmock/gmock.h>

#include "common/service/ros/parameters.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::service {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Words = std::vector<std::string>;

tl::expected<RosArguments, std::string> read(const Words& arguments) {
  return read_ros_arguments(arguments, "rds_tracker", "/");
}

TEST(RosArguments, StandBetweenTheirMarkAndTheNextDoubleDash) {
  const CommandLine line = split_command_line(
      {"--bus", "fastdds", "--ros-args", "-r", "a:=b", "--", "--domain", "3", "--ros-args", "-p", "c:=1"});
  EXPECT_THAT(line.own, ElementsAre("--bus", "fastdds", "--domain", "3"));
  EXPECT_THAT(line.ros, ElementsAre("-r", "a:=b", "-p", "c:=1"));
}

TEST(RosArguments, NameNodeNamespaceAndTopics) {
  const auto arguments = read({"-r", "__node:=slam", "--remap", "__ns:=/robot1", "-r", "/tf:=tf", "-r",
                               "rds_tracker:a:=b", "-r", "another:c:=d", "--log-level", "WARN"});
  ASSERT_TRUE(arguments) << arguments.error();
  EXPECT_EQ(arguments->node_name, "slam");
  EXPECT_EQ(arguments->node_namespace, "/robot1");
  EXPECT_EQ(arguments->log_level, "warning");
  ASSERT_EQ(arguments->remappings.size(), 2U);
  EXPECT_EQ(arguments->remappings[0].from, "/tf");
  EXPECT_EQ(arguments->remappings[0].to, "tf");
  EXPECT_EQ(arguments->remappings[1].to, "b") << "another node's rule is not this one's";
}

TEST(RosArguments, SetParametersByTheirPath) {
  const auto arguments =
      read({"-p", "camera.color:=camera/rgb/image_raw", "-p", "camera.pairing_tolerance_s:=0.05", "-p",
            "use_sim_time:=true", "-p", "other_node:dynamics:=false"});
  ASSERT_TRUE(arguments) << arguments.error();
  EXPECT_EQ(arguments->parameters["camera"]["color"].as<std::string>(), "camera/rgb/image_raw");
  EXPECT_EQ(arguments->parameters["camera"]["pairing_tolerance_s"].as<double>(), 0.05);
  EXPECT_EQ(arguments->parameters.size(), 1U)
      << "what every node of ROS has, and what is another one's, is left out";
}

TEST(RosArguments, ReadTheSectionsOfTheNodeInParameterFiles) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "params.yaml").string();
  std::ofstream(file) << "/**:\n  ros__parameters: {dynamics: false, camera: {color: everybody}}\n"
                         "/robot1:\n  rds_tracker:\n    ros__parameters: {camera.color: mine}\n"
                         "/robot2/rds_tracker:\n  ros__parameters: {camera.color: another}\n"
                         "rds_tracker:\n  ros__parameters: {loop_closer: false}\n";
  const auto arguments = read({"--params-file", file, "-r", "__ns:=/robot1", "-p", "nice:=3"});
  ASSERT_TRUE(arguments) << arguments.error();
  EXPECT_EQ(arguments->parameters["dynamics"].as<bool>(), false);
  EXPECT_EQ(arguments->parameters["camera"]["color"].as<std::string>(), "mine");
  EXPECT_EQ(arguments->parameters["nice"].as<int>(), 3);
  EXPECT_FALSE(arguments->parameters["loop_closer"])
      << "/rds_tracker is another node than /robot1/rds_tracker";
}

TEST(RosArguments, SayWhatIsWrong) {
  EXPECT_THAT(read({"-r", "nothing"}).error(), HasSubstr("expected from:=to"));
  EXPECT_THAT(read({"-p", ":=1"}).error(), HasSubstr("expected name:=value"));
  EXPECT_THAT(read({"-r"}).error(), HasSubstr("expected a value"));
  EXPECT_THAT(read({"-r", "__node:=my-node"}).error(), HasSubstr("letters, digits and underscores"));
  EXPECT_THAT(read({"--log-level", "loud"}).error(), HasSubstr("debug, info, warn"));
  EXPECT_THAT(read({"--params-file", "/nowhere.yaml"}).error(), HasSubstr("/nowhere.yaml: cannot be read"));
  EXPECT_THAT(read({"--verbose"}).error(), HasSubstr("--verbose: not an argument of ROS"));
}

TEST(ParameterFile, MeansNodesByPatterns) {
  EXPECT_TRUE(is_meant("/**", "/a/b/node"));
  EXPECT_TRUE(is_meant("/*/node", "/a/node"));
  EXPECT_TRUE(is_meant("/**/node", "/node"));
  EXPECT_TRUE(is_meant("node", "/node"));
  EXPECT_FALSE(is_meant("/*/node", "/a/b/node"));
  EXPECT_FALSE(is_meant("/node", "/a/node"));
}

}  // namespace
}  // namespace rds::service
