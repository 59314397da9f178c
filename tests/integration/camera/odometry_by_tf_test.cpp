// SPDX-License-Identifier: Apache-2.0
// A robot that tells its odometry on tf alone: the tracker reads it there, each frame in lockstep as far as
// it needs it.
#include <gmock/gmock.h>

#include "common/messages/conversions.hpp"
#include "tests/integration/camera/camera_driver.hpp"
#include "tests/integration/camera/told_diagnostics.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/test_domain.hpp"

namespace rds::test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::size_t kFrames = 10;
constexpr std::int64_t kStepNs = 20'000'000;
const std::string kOptical = "camera_color_optical_frame";

class OdometryByTf : public testing::TestWithParam<bus::Vendor> {
 protected:
  OdometryByTf() {
    static_ = driver_.bus().advertise<tf2_msgs::msg::TFMessage>("/tf_static", bus::kLatched);
    tf_ = driver_.bus().advertise<tf2_msgs::msg::TFMessage>("/tf", {.reliable = true, .depth = 500});
    static_.write(tree("base_footprint", kOptical, 0, 0));
    for (int i = 0; tf_.matched() == 0 && i < 500; ++i) std::this_thread::sleep_for(20ms);
  }
  static tf2_msgs::msg::TFMessage tree(const std::string& parent, const std::string& child, double x,
                                       std::int64_t stamp_ns) {
    geometry_msgs::msg::TransformStamped transform;
    transform.header(messages::make_header(stamp_ns, parent));
    transform.child_frame_id(child);
    transform.transform(
        messages::to_transform_message(geometry::make_pose({x, 0, 0}, Eigen::Quaterniond::Identity())));
    tf2_msgs::msg::TFMessage tree;
    tree.transforms().push_back(transform);
    return tree;
  }
  /// Frames, before each of them what the wheels tell up to its time, and other transforms. @return messages
  /// of odometry.
  std::size_t track() {
    const auto& frames = TrackerWithDriver::frames();
    std::int64_t at_ns = frames[0].stamp_ns - 5 * kStepNs;
    std::size_t count = 0;
    for (std::size_t i = 0; i < kFrames; ++i) {
      for (bool is_through = false; !is_through; at_ns += kStepNs, ++count) {
        is_through = at_ns >= frames[i].stamp_ns;
        tf_.write(tree("map", "elsewhere", 0, at_ns));
        tf_.write(tree("odom", "base_footprint", 1e-10 * static_cast<double>(at_ns), at_ns));
      }
      driver_.track(i);
    }
    std::this_thread::sleep_for(2500ms);  // diagnostics come once a second
    return count;
  }

  TrackerWithDriver driver_{
      GetParam(),
      test_domain(),
      {},
      "{lockstep: true, dynamics: false, loop_closer: false, inputs: {odometry_frame: odom}}"};
  bus::Publisher<tf2_msgs::msg::TFMessage> static_;
  bus::Publisher<tf2_msgs::msg::TFMessage> tf_;
  ToldDiagnostics told{driver_.bus()};
};

TEST_P(OdometryByTf, IsReadFromTheFrameThatIsNamed) {
  const std::size_t count = track();
  EXPECT_EQ(told("odometry messages"), std::to_string(count)) << driver_.log();
  EXPECT_THAT(driver_.log(), Not(HasSubstr("has come on"))) << "a frame has waited in vain";
  EXPECT_THAT(driver_.log(), Not(HasSubstr("no odometry of the pictures' time")));
}

INSTANTIATE_TEST_SUITE_P(Of, OdometryByTf, testing::ValuesIn(kAllVendors), vendor_name);

}  // namespace
}  // namespace rds::test
