// SPDX-License-Identifier: Apache-2.0
// Bags of a robot: depth in a frame of its own, an IMU and odometry that tf joins with the camera.
#include <algorithm>

#include <gmock/gmock.h>

#include "common/bus/type_ops.hpp"
#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/recording/camera_messages.hpp"
#include "tools/recording/conversion.hpp"
#include "tools/recording/open_recording.hpp"

namespace rds::recording {
namespace {

using geometry::Pose;
using messages::make_header;
using testing::AllOf;
using testing::HasSubstr;

constexpr std::int64_t kFrameNs = 33'000'000;
constexpr int kFrames = 3;

Pose at(double x, double y, double z) {
  return geometry::make_pose({x, y, z}, Eigen::Quaterniond::Identity());
}
Pose link_from_optical() {  // REP 103
  return geometry::make_pose({0, 0, 0}, Eigen::Quaterniond(-0.5, 0.5, -0.5, 0.5));
}

geometry_msgs::msg::TransformStamped transform(const std::string& parent, const std::string& child,
                                               const Pose& pose, std::int64_t stamp_ns = 0) {
  geometry_msgs::msg::TransformStamped message;
  message.header(make_header(stamp_ns, parent));
  message.child_frame_id(child);
  message.transform(messages::to_transform_message(pose));
  return message;
}

class RobotBag : public testing::Test {
 protected:
  template <class Message>
  void add(const std::string& topic, const Message& message) {
    const auto& type = bus::type_ops<Message>();
    const auto known = std::ranges::find(names_, topic);
    const auto number = static_cast<std::size_t>(known - names_.begin());
    if (known == names_.end()) {
      names_.push_back(topic);
      EXPECT_EQ(writer_->add_topic(topic_of(topic, type, "")).value(), number);
    }
    Bytes bytes(type.encoded_size(&message));
    bytes.resize(type.encode(&message, bytes.data(), bytes.size()));
    EXPECT_TRUE(writer_->write(number, {++time_, time_, bytes}));
  }
  /// A camera with colour in "color", and this depth picture in a frame and with a camera of its own.
  void add_camera(const std::string& depth_frame, const cv::Mat1w& depth, const geometry::CameraModel* info) {
    for (std::int64_t i = 1; i <= kFrames; ++i) {
      const std::int64_t stamp_ns = i * kFrameNs;
      add("/cam/color/image_raw",
          messages::to_image_message({cv::Mat3b(24, 32), image::ChannelOrder::kRgb, nullptr},
                                     make_header(stamp_ns, "color")));
      add("/cam/color/camera_info", messages::to_camera_info(color, make_header(stamp_ns, "color")));
      add("/cam/depth/image_rect_raw", messages::to_image_message(image::DepthImage{depth, 0.001F, nullptr},
                                                                  make_header(stamp_ns, depth_frame)));
      if (info != nullptr)
        add("/cam/depth/camera_info", messages::to_camera_info(*info, make_header(stamp_ns, depth_frame)));
    }
  }
  void add_transforms(const std::string& topic,
                      std::vector<geometry_msgs::msg::TransformStamped> transforms) {
    tf2_msgs::msg::TFMessage tree;
    tree.transforms(std::move(transforms));
    add(topic, tree);
  }
  void add_odometry(const std::string& topic, const std::string& body, int count) {
    for (int i = 0; i < count; ++i) {
      nav_msgs::msg::Odometry odometry;
      odometry.header(make_header(i * kFrameNs, "odom"));
      odometry.child_frame_id(body);
      odometry.pose().pose(messages::to_pose_message(at(0.1 * i, 0, 0)));
      add(topic, odometry);
    }
  }
  void add_imu(const std::string& topic, const std::string& frame, int count, bool has_gyroscope = true) {
    for (int i = 0; i < count; ++i) {
      sensor_msgs::msg::Imu imu;
      imu.header(make_header(i * kFrameNs, frame));
      imu.linear_acceleration().z(9.81);
      if (!has_gyroscope) imu.angular_velocity_covariance()[0] = -1;
      add(topic, imu);
    }
  }
  auto open() {
    EXPECT_TRUE(writer_->finish());
    return open_recording(folder / "a.mcap");
  }
  test::TemporaryFolder folder;
  geometry::CameraModel color{.width = 32, .height = 24, .fx = 30, .fy = 30, .cx = 15.5, .cy = 11.5};
  geometry::CameraModel half{.width = 16, .height = 12, .fx = 15, .fy = 15, .cx = 7.5, .cy = 5.5};
  cv::Mat1w near = cv::Mat1w(12, 16, std::uint16_t{1500});

 private:
  std::unique_ptr<BagWriter> writer_ = make_bag_writer(folder / "a.mcap", mcap::Compression::kLz4).value();
  std::vector<std::string> names_;
  std::int64_t time_ = 0;
};

TEST_F(RobotBag, DepthInAnotherFrameIsRegisteredToColour) {
  near.colRange(8, 16) = std::uint16_t{3000};  // the right half is twice as far
  add_camera("depth", near, &half);
  add_transforms("/tf_static",
                 {transform("link", "color", at(0, 0, 0)), transform("link", "depth", at(0.25, 0, 0))});
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error();
  EXPECT_THAT(opened->notes, HasSubstr("of 16×12 px in frame 'depth', registered to colour"));
  const auto frame = opened->recording->load(opened->recording->frames()[1]);
  ASSERT_TRUE(frame) << frame.error();
  EXPECT_EQ(frame->depth.values.size(), cv::Size(32, 24));
  // 25 cm to the right of colour's camera: 30 px · .25 m / 1.5 m = 5 px, so the rim at 15.5 is at 20.5.
  EXPECT_FLOAT_EQ(frame->depth.at(18, 12), 1.5F);
  EXPECT_FLOAT_EQ(frame->depth.at(24, 12), 3.0F);
  EXPECT_EQ(frame->depth.at(1, 12), 0) << "colour alone sees it";
  ASSERT_TRUE(write_tum_folder(*opened->recording, folder / "tum"));
  const auto again = open_recording(folder / "tum").value();
  EXPECT_EQ(cv::norm(again.recording->load(again.recording->frames()[1])->depth.values, frame->depth.values,
                     cv::NORM_INF),
            0);
}

TEST_F(RobotBag, DepthOfAnotherSizeInColoursFrameNeedsNoTransform) {
  add_camera("color", near, &half);
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error();
  EXPECT_FLOAT_EQ(opened->recording->load(opened->recording->frames()[0])->depth.at(16, 12), 1.5F);
}

TEST_F(RobotBag, DepthThatCannotBeRegisteredIsRefused) {
  add_camera("depth", near, &half);
  EXPECT_THAT(open().error(),
              AllOf(HasSubstr("a.mcap: /cam/depth/image_rect_raw"), HasSubstr("no tf joins")));
}

TEST_F(RobotBag, DepthWithoutItsCameraIsRefused) {
  add_camera("color", near, nullptr);
  EXPECT_THAT(open().error(), AllOf(HasSubstr("16×12"), HasSubstr("camera_info")));
}

TEST_F(RobotBag, DepthOfColoursSizeIsTakenAsRegisteredWhereNothingSaysOtherwise) {
  add_camera("depth", cv::Mat1w(24, 32, std::uint16_t{2000}), nullptr);
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error();
  EXPECT_THAT(opened->notes, HasSubstr("taken as registered"));
  EXPECT_FLOAT_EQ(opened->recording->load(opened->recording->frames()[0])->depth.at(0, 0), 2.0F);
}

TEST_F(RobotBag, SensorsStandWhereTfSays) {
  add_camera("color", cv::Mat1w(24, 32, std::uint16_t{2000}), nullptr);
  add_imu("/board/imu", "board", 4);
  add_odometry("/wheels/odom", "/base", 5);
  add_transforms("/tf_static",
                 {transform("base", "link", at(0.1, 0, 0.4)), transform("link", "color", link_from_optical()),
                  transform("base", "board", at(0, 0, 0.1))});
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error();
  const auto& [imu, odometry] = opened->recording->sensors();
  ASSERT_TRUE(imu && odometry) << opened->notes;
  EXPECT_TRUE(odometry->body_from_camera.isApprox(at(0.1, 0, 0.4) * link_from_optical(), 1e-9));
  EXPECT_EQ(odometry->odom_from_body.size(), 5U);
  EXPECT_TRUE((imu->camera_from_imu.linear() * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(0, -1, 0)));
  EXPECT_EQ(imu->measurements.size(), 4U);
  // What is played of them stands there again.
  const auto mounting = mounting_message(opened->recording->sensors());
  ASSERT_TRUE(mounting);
  ASSERT_EQ(mounting->transforms().size(), 2U);
  EXPECT_EQ(mounting->transforms()[0].child_frame_id(), mounting->transforms()[1].header().frame_id());
  EXPECT_EQ(odometry_message(*odometry, Pose::Identity(), 1).child_frame_id(),
            mounting->transforms()[0].header().frame_id());
  EXPECT_EQ(imu_message(*imu, imu->measurements[0], 1).header().frame_id(),
            mounting->transforms()[1].child_frame_id());
}

TEST_F(RobotBag, OdometryMayBeInTfAlone) {
  add_camera("color", cv::Mat1w(24, 32, std::uint16_t{2000}), nullptr);
  add_transforms("/tf_static", {transform("base", "color", at(0, 0, 1))});
  for (int i = 0; i < 4; ++i)
    add_transforms("/tf", {transform("map", "odom", at(9, 9, 9), i * kFrameNs),
                           transform("odom", "base", at(0.5 * i, 0, 0), i * kFrameNs)});
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error();
  EXPECT_THAT(opened->notes, HasSubstr("odometry tf from odom to base"));
  const auto& odometry = opened->recording->sensors().odometry;
  ASSERT_TRUE(odometry);
  EXPECT_TRUE(odometry->body_from_camera.isApprox(at(0, 0, 1), 1e-9));
  ASSERT_EQ(odometry->odom_from_body.size(), 4U);
  EXPECT_EQ(odometry->odom_from_body[3].map_from_camera.translation(), Eigen::Vector3d(1.5, 0, 0));
}

TEST_F(RobotBag, WhatOurTrackerSaidIsNoRobotsOdometry) {
  add_camera("color", cv::Mat1w(24, 32, std::uint16_t{2000}), nullptr);
  add_odometry("/rds/odometry", "color", 4);
  add_transforms("/tf", {transform("odom", "color", at(1, 0, 0))});
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error();
  EXPECT_FALSE(opened->recording->sensors().odometry);
}

TEST_F(RobotBag, SensorsThatNoTfJoinsAreToldOf) {
  add_camera("color", cv::Mat1w(24, 32, std::uint16_t{2000}), nullptr);
  add_imu("/imu", "nowhere", 4);
  add_odometry("/odom", "base", 5);
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error();
  EXPECT_THAT(opened->notes, AllOf(HasSubstr("/imu is not used: no tf joins its frame 'nowhere'"),
                                   HasSubstr("/odom is not used: no tf joins its frame 'base'")));
  EXPECT_FALSE(opened->recording->sensors().imu || opened->recording->sensors().odometry);
}

TEST_F(RobotBag, OfSeveralSensorsTheOneOfOurNameIsTaken) {
  add_camera("color", cv::Mat1w(24, 32, std::uint16_t{2000}), nullptr);
  add_imu("/camera/gyro/sample", "color", 9);
  add_imu("/camera/imu", "color", 2, false);
  add_odometry("/vo", "color", 9);
  add_odometry("/odom", "color", 2);
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error();
  EXPECT_EQ(opened->recording->sensors().imu->measurements.size(), 2U);
  EXPECT_FALSE(opened->recording->sensors().imu->has_gyroscope);
  EXPECT_EQ(opened->recording->sensors().odometry->odom_from_body.size(), 2U);
}

}  // namespace
}  // namespace rds::recording
