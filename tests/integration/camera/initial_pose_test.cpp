// SPDX-License-Identifier: Apache-2.0
// What a tracker says to who tells it where the robot is, as RViz' "2D Pose Estimate" does. How a lost camera
// then looks for itself is in the tests of the relocaliser.
#include <gtest/gtest.h>

#include "common/messages/conversions.hpp"
#include "geometry_msgs/msg/PoseWithCovarianceStamped.h"
#include "tests/integration/camera/camera_driver.hpp"
#include "tests/support/test_domain.hpp"

namespace rds::test {
namespace {

class InitialPose : public testing::Test {
 protected:
  InitialPose() {
    told_ = driver_.bus().advertise<geometry_msgs::msg::PoseWithCovarianceStamped>(
        "initialpose", {.reliable = true, .depth = 1});
    for (int i = 0; told_.matched() == 0 && i < 500; ++i) std::this_thread::sleep_for(20ms);
  }
  void tell(const std::string& frame) {
    geometry_msgs::msg::PoseWithCovarianceStamped message;
    message.header(messages::make_header(TrackerWithDriver::frames()[0].stamp_ns, frame));
    message.pose().pose(
        messages::to_pose_message(geometry::make_pose({1, 2, 0}, Eigen::Quaterniond::Identity())));
    told_.write(message);
  }
  bool is_said(const std::string& words) {
    return driver_.publish_until([&] { return driver_.log().find(words) != std::string::npos; });
  }

  TrackerWithDriver driver_{
      bus::Vendor::kFastDds, test_domain(), {}, "{inputs: {initial_pose: initialpose}}"};
  bus::Publisher<geometry_msgs::msg::PoseWithCovarianceStamped> told_;
};

TEST_F(InitialPose, IsNotUsedByACameraThatIsNotLost) {
  ASSERT_TRUE(driver_.publish_until([&] { return driver_.tracked() >= 5; })) << driver_.log();
  tell("map");
  EXPECT_TRUE(is_said("an initial pose at (1.00, 2.00) is not used: the camera is not lost"))
      << driver_.log();
}

TEST_F(InitialPose, InAnotherFrameIsRefused) {
  tell("odom");
  EXPECT_TRUE(is_said("initialpose: message dropped, invalid: expected a pose in map")) << driver_.log();
}

}  // namespace
}  // namespace rds::test
