// SPDX-License-Identifier: Apache-2.0
#include <future>
#include <numbers>
#include <optional>
#include <set>
#include <thread>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "common/messages/conversions.hpp"
#include "common/topics/topics.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "nav_msgs/msg/Path.h"
#include "tests/integration/camera/camera_driver.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/shared_data.hpp"
#include "tf2_msgs/msg/TFMessage.h"

/// The tree of frames that a tracker makes with what others publish.
namespace rds::test {
namespace {

using geometry::Pose;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

constexpr int kDomain = 143;
constexpr std::int64_t kMastNs = 20'000'000;
constexpr double kDeg = 180 / std::numbers::pi;
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

tf2_msgs::msg::TFMessage tree_of(const geometry_msgs::msg::TransformStamped& transform) {
  tf2_msgs::msg::TFMessage message;
  message.transforms().push_back(transform);
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
          told_.push_back(messages::to_pose(m->pose().pose()).value());
        }));
  }
  void publish_robot() {
    tf2_msgs::msg::TFMessage tree;
    tree.transforms().push_back(transform("base_link", "camera_link", base_from_link()));
    tree.transforms().push_back(transform("camera_link", kOptical, link_from_optical()));
    static_.write(tree);
    std::this_thread::sleep_for(500ms);  // the tracker has read it before the first frame
  }
  /// The child's poses of all odometry.
  std::vector<Pose> told() {
    std::this_thread::sleep_for(100ms);
    const std::lock_guard lock(mutex_);
    return told_;
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
  std::vector<Pose> told_;
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

/// A mast turns and moves the camera as the recording's has moved, and tf tells of it 50 times a second, each
/// time before the picture of a later time: the base stands.
TEST_P(Frames, OfACameraThatMovesOnItsRobotLeaveTheBaseInItsPlace) {
  start({});
  static_.write(tree_of(transform("camera_link", kOptical, link_from_optical())));
  const auto truth = TrackerWithDriver::truth();
  const auto& frames = TrackerWithDriver::frames();
  const auto base_from_camera = [&, first = geometry::interpolate(truth, frames[0].stamp_ns)](auto stamp_ns) {
    return base_from_link() * link_from_optical() * first.inverse() * geometry::interpolate(truth, stamp_ns);
  };
  double moved_rad = 0;
  for (std::int64_t i = 0, ns = frames[0].stamp_ns - kMastNs; i < std::ssize(frames); ++i) {
    const auto& frame = frames[static_cast<std::size_t>(i)];
    for (; ns < frame.stamp_ns; ns += kMastNs)
      wheels_.write(tree_of(
          transform("base_link", "camera_link", base_from_camera(ns) * link_from_optical().inverse(), ns)));
    std::this_thread::sleep_for(i == 0 ? 500ms : 10ms);  // as long as a camera takes; the tracker has read it
    driver_->track(static_cast<std::size_t>(i));
    const Pose moved = base_from_camera(frame.stamp_ns) * base_from_camera(frames[0].stamp_ns).inverse();
    moved_rad = std::max(moved_rad, geometry::rotation_angle_rad(moved.linear()));
  }
  const std::vector<Pose> bases = told();
  ASSERT_GE(bases.size(), frames.size());
  double off_m = 0, off_rad = 0;
  for (const Pose& base : bases) {
    off_m = std::max(off_m, (base.translation() - bases[0].translation()).norm());
    off_rad = std::max(off_rad, geometry::rotation_angle_rad(bases[0].linear().transpose() * base.linear()));
  }
  fmt::print("the camera has turned by {:.1f} deg, the base by {:.2f} deg and {:.1f} mm\n", moved_rad * kDeg,
             off_rad * kDeg, 1e3 * off_m);
  const TestRecording recording = recording_of_a_room();
  EXPECT_GT(moved_rad * kDeg, recording.bound(5, 1));
  EXPECT_LT(off_m, recording.bound(0.03, 0.02));
  EXPECT_LT(off_rad * kDeg, recording.bound(3, 1)) << "the recorded truth is itself wrong by 2 degrees";
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
  wheels_.write(
      tree_of(transform("odom", "base_link", odom_from_base, TrackerWithDriver::frames()[0].stamp_ns)));
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

INSTANTIATE_TEST_SUITE_P(Of, Frames, ::testing::ValuesIn(kAllVendors), vendor_name);

INSTANTIATE_TEST_SUITE_P(Of, FramesBesideFastDds, ::testing::Values(bus::Vendor::kFastDds));

}  // namespace
}  // namespace rds::test
