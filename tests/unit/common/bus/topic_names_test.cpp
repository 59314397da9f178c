// SPDX-License-Identifier: Apache-2.0
#include "common/bus/names/topic_names.hpp"

#include <stdexcept>

#include <gmock/gmock.h>

namespace rds::bus {
namespace {

TEST(TopicNames, AreThoseThatWereAskedForWithoutANamespace) {
  const TopicNames names("/", "rds_tracker", {});
  EXPECT_EQ(names.full_name("rds/odometry"), "rds/odometry");
  EXPECT_EQ(names.full_name("/tf"), "tf");
  EXPECT_EQ(names.full_name("~/state"), "rds_tracker/state");
}

TEST(TopicNames, StandBelowTheNamespaceUnlessTheyAreAbsolute) {
  const TopicNames names("fleet/robot1/", "rds_tracker", {});
  EXPECT_EQ(names.node_namespace(), "/fleet/robot1");
  EXPECT_EQ(names.full_name("rds/odometry"), "fleet/robot1/rds/odometry");
  EXPECT_EQ(names.full_name("/tf"), "tf");
  EXPECT_EQ(names.full_name("~/state"), "fleet/robot1/rds_tracker/state");
}

TEST(TopicNames, AreRemappedByTheirFullNames) {
  const std::vector<Remapping> rules{
      {"/tf", "tf"}, {"camera/color", "/driver/rgb"}, {"/robot1/a", "b"}, {"a", "c"}};
  const TopicNames names("/robot1", "node", rules);
  EXPECT_EQ(names.full_name("/tf"), "robot1/tf");
  EXPECT_EQ(names.full_name("camera/color"), "driver/rgb");
  EXPECT_EQ(names.full_name("a"), "robot1/b") << "the first rule that fits";
  EXPECT_EQ(names.full_name("b"), "robot1/b");
}

TEST(TopicNames, RefuseANamespaceThatRosWouldRefuse) {
  for (const char* name : {"/robot-1", "1robot", "/robot1//a", "/robot 1"})
    EXPECT_THROW(normal_namespace(name), std::invalid_argument) << name;
  EXPECT_EQ(normal_namespace(""), "/");
  EXPECT_EQ(normal_namespace("robot_1"), "/robot_1");
}

TEST(RosName, HasLettersDigitsAndUnderscores) {
  for (const char* name : {"rds_tracker", "_a", "A1"}) EXPECT_TRUE(is_ros_name(name)) << name;
  for (const char* name : {"", "rds-tracker", "1a", "a/b"}) EXPECT_FALSE(is_ros_name(name)) << name;
}

}  // namespace
}  // namespace rds::bus
