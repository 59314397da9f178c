// SPDX-License-Identifier: Apache-2.0
#include <future>
#include <optional>
#include <set>
#include <thread>

#include <Eigen/Eigenvalues>
#include <gmock/gmock.h>

#include "common/messages/conversions.hpp"
#include "common/topics/topics.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "nav_msgs/msg/Path.h"
#include "tests/integration/camera/camera_driver.hpp"
#include "tf2_msgs/msg/TFMessage.h"

/// The tree of frames that a tracker makes with what others publish.
namespace rds::test {
namespace {

using geometry::Pose;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

constexpr int kDomain = 143;
const std::string kOptical = "camera_color_optical_frame";

Pose base_from_link() {  // mounted 40 cm above the base, tilted by 20°
  return geometry::make_pose({0.1, 0, 0.4},
                             Eigen::Quaterniond(Eigen::AngleAxisd(0.35, Eigen::Vector3d::UnitY())));
}
Pose link_from_optical() {  // REP 103
  return geometry::make_pose({0, 0.015, 0}, Eigen::Quaterniond(-0.5, 0.5, -0.5, 0.5));
}

geometry_msgs::msg::TransformStamped transform(const std::string& parent, const std::string& child,
                                               const Pose& pose, std::int64_t stamp_ns = 0) {
  geometry_msgs::msg::TransformStamped message;
  message.header(messages::make_header(stamp_ns, parent));
  message.child_frame_id(child);
  message.transform(messages::to_transform_message(pose));
  return message;
}

/// What the tracker publishes beside a robot's nodes.
class Frames : public ::testing::TestWithParam<bus::Vendor> {
 protected:
  using Tree = std::set<std::pair<std::string, std::string>>;  // parent, child

  void start(const DriverHabits& habits, const std::string& settings = "{}") {
    driver_.emplace(GetParam(), kDomain, habits, settings);
    bus::Participant& bus = driver_->bus();
    static_ = bus.advertise<tf2_msgs::msg::TFMessage>("tf_static", bus::kLatched);
    wheels_ = bus.advertise<tf2_msgs::msg::TFMessage>("tf", bus::kTransform);
    subscriptions_.push_back(bus.subscribe<tf2_msgs::msg::TFMessage>(
        "tf", bus::kTransform, [this, self = bus.id()](const auto& m, const bus::ParticipantId& writer) {
          const std::lock_guard lock(mutex_);
          if (writer == self) return;
          for (const auto& t : m->transforms()) {
            seen_.emplace(t.header().frame_id(), t.child_frame_id());
            if (t.header().frame_id() == "map") map_from_odom_ = messages::to_pose(t.transform()).value();
          }
        }));
    subscriptions_.push_back(
        bus.subscribe<nav_msgs::msg::Odometry>("rds/odometry", bus::kStream, [this](const auto& m) {
          const std::lock_guard lock(mutex_);
          odometry_ = *m;
        }));
  }
  void publish_robot() {
    tf2_msgs::msg::TFMessage tree;
    tree.transforms().push_back(transform("base_link", "camera_link", base_from_link()));
    tree.transforms().push_back(transform("camera_link", kOptical, link_from_optical()));
    static_.write(tree);
    std::this_thread::sleep_for(500ms);  // the tracker has read it before the first frame
  }
  Tree seen() {
    const std::lock_guard lock(mutex_);
    return seen_;
  }
  void track(std::size_t frames = 8) {
    for (std::size_t i = 0; i < frames; ++i) state_ = driver_->track(i);
    std::this_thread::sleep_for(100ms);
  }

  std::optional<TrackerWithDriver> driver_;
  bus::Publisher<tf2_msgs::msg::TFMessage> static_;
  bus::Publisher<tf2_msgs::msg::TFMessage> wheels_;
  rds_msgs::msg::TrackingState state_;
  std::mutex mutex_;
  Tree seen_;
  Pose map_from_odom_ = Pose::Identity();
  nav_msgs::msg::Odometry odometry_;
  std::vector<bus::Subscription> subscriptions_;
};

TEST_P(Frames, OfARobotWithItsOwnTreeHangTheBaseBelowOdom) {
  start({});
  publish_robot();
  track();
  EXPECT_THAT(seen(), UnorderedElementsAre(Pair("map", "odom"), Pair("odom", "base_link")))
      << "the optical frame has a parent already";
  EXPECT_EQ(odometry_.header().frame_id(), "odom");
  EXPECT_EQ(odometry_.child_frame_id(), "base_link");
  const Pose map_from_base = map_from_odom_ * messages::to_pose(odometry_.pose().pose()).value();
  const Pose expected = messages::to_pose(state_.map_from_camera()).value() *
                        (base_from_link() * link_from_optical()).inverse();
  EXPECT_TRUE(map_from_base.isApprox(expected, 1e-6));
  for (const auto* covariance : {&odometry_.pose().covariance(), &odometry_.twist().covariance()}) {
    const Eigen::Map<const Eigen::Matrix<double, 6, 6>> matrix(covariance->data());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues().minCoeff(), 0);
    EXPECT_LT(matrix.trace(), 1) << "known by now";
  }
}

/// What does not depend on the vendor.
class FramesBesideFastDds : public Frames {};

TEST_P(FramesBesideFastDds, OfACameraAloneHangItBelowOdomByThePicturesFrame) {
  start({.frame = "zed_left_optical_frame", .depth_frame = "zed_left_optical_frame"});
  track();
  EXPECT_THAT(seen(), UnorderedElementsAre(Pair("map", "odom"), Pair("odom", "zed_left_optical_frame")));
}

TEST_P(FramesBesideFastDds, LeaveOdomToWheelOdometry) {
  start({});
  publish_robot();
  const Pose odom_from_base = geometry::make_pose({3, 1, 0}, Eigen::Quaterniond::Identity());
  tf2_msgs::msg::TFMessage wheels;
  wheels.transforms().push_back(
      transform("odom", "base_link", odom_from_base, TrackerWithDriver::frames()[0].stamp_ns));
  wheels_.write(wheels);
  std::this_thread::sleep_for(300ms);
  track();
  EXPECT_THAT(seen(), UnorderedElementsAre(Pair("map", "odom")));
  const Pose expected = messages::to_pose(state_.map_from_camera()).value() *
                        (odom_from_base * base_from_link() * link_from_optical()).inverse();
  EXPECT_TRUE(map_from_odom_.isApprox(expected, 1e-6));
}

TEST_P(FramesBesideFastDds, AreNotToldWhereASettingSaysSo) {
  start({}, "{frames: {publish_tf: false}}");
  track();
  EXPECT_TRUE(seen().empty());
  EXPECT_EQ(odometry_.child_frame_id(), kOptical) << "odometry is";
}

TEST_P(Frames, APathOfKeyframesIsThereForWhoComesLate) {
  start({});
  track();
  std::promise<nav_msgs::msg::Path> told;
  const auto paths = driver_->bus().subscribe<nav_msgs::msg::Path>(
      "rds/trajectory", bus::kLatched, [&, is_first = true](const auto& m) mutable {
        if (std::exchange(is_first, false)) told.set_value(*m);
      });
  auto path = told.get_future();
  ASSERT_EQ(path.wait_for(10s), std::future_status::ready);
  const nav_msgs::msg::Path way = path.get();
  EXPECT_EQ(way.header().frame_id(), "map");
  ASSERT_FALSE(way.poses().empty());
  EXPECT_EQ(messages::to_nanoseconds(way.poses().front().header().stamp()),
            TrackerWithDriver::frames()[0].stamp_ns);
  EXPECT_LT(messages::to_pose(way.poses().front().pose()).value().translation().norm(), 1e-3)
      << "the map begins there";
}

INSTANTIATE_TEST_SUITE_P(Of, Frames, ::testing::Values(bus::Vendor::kFastDds, bus::Vendor::kCycloneDds),
                         [](const auto& vendor) { return name_of(vendor.param); });

INSTANTIATE_TEST_SUITE_P(Of, FramesBesideFastDds, ::testing::Values(bus::Vendor::kFastDds));

}  // namespace
}  // namespace rds::test
