// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/bus/participant.hpp"
#include "common/geometry/trajectory.hpp"
#include "common/image/rgbd_frame.hpp"
#include "rds_msgs/msg/TrackingState.h"
#include "sensor_msgs/msg/CameraInfo.h"
#include "sensor_msgs/msg/CompressedImage.h"
#include "sensor_msgs/msg/Image.h"
#include "tests/support/process.hpp"
#include "tf2_msgs/msg/TFMessage.h"

namespace rds::test {

using namespace std::chrono_literals;

/// What a driver makes of the pictures that it has. An empty topic is not published.
struct DriverHabits {
  std::string color_topic = "camera/color/image_raw";
  std::string info_topic = "camera/color/camera_info";
  std::string depth_topic = "camera/aligned_depth_to_color/image_raw";
  std::string frame = "camera_color_optical_frame";
  std::string depth_frame = frame;
  bool best_effort = false;
  bool compressed = false;               // JPEG and compressedDepth in place of pictures as they are
  std::int64_t depth_delay_ns = 0;       // of its stamps
  std::string encoding = "rgb8";         // of colour
  bool half_depth = false;               // of half the size, with a camera_info of its own
  bool depth_apart = false;              // by such a camera 5 cm to the left of colour's, as tf_static says
  std::string distortion = "plumb_bob";  // that pictures are made with, and camera_info says
};

/// A camera with every other pixel of another one's, from the first on.
geometry::CameraModel half_of(geometry::CameraModel camera);
/// Where depth's camera stands, if it stands apart: 5 cm to the left of colour's.
geometry::Pose color_from_depth();
/// The depth picture that a camera there has of the same: every point falls on one of its pixels.
image::DepthImage seen_from_depth(const image::RgbdFrame& frame, const geometry::CameraModel& camera);

/// rds-tracker as a process, and this program as a camera driver beside it.
class TrackerWithDriver {
 public:
  TrackerWithDriver(bus::Vendor vendor, int domain, const DriverHabits& habits,
                    const std::string& settings = "{}");

  /// Publishes the frames of a recording over and over, 20 a second, until a condition holds. @return whether
  /// it did.
  bool publish_until(const std::function<bool()>& condition, std::chrono::seconds limit = 20s);
  /// Publishes one frame of the recording with its own stamp, and waits until the tracker has acknowledged
  /// it.
  rds_msgs::msg::TrackingState track(std::size_t index);

  /// The newest message of the tracker's diagnostics.
  std::string diagnosis();
  /// Frames that have a pose.
  std::size_t tracked();
  std::string log() const { return tracker_.standard_error(); }
  bus::Participant& bus() { return *bus_; }
  /// The first frames of a recording of a room, and its true path.
  static const std::vector<image::RgbdFrame>& frames();
  static std::vector<geometry::StampedPose> truth();

 private:
  void publish(const image::RgbdFrame& frame, std::int64_t stamp_ns);
  void publish_depth(const image::RgbdFrame& frame, std::int64_t stamp_ns);
  void publish_mounting();

  DriverHabits habits_;
  TemporaryFolder place_;
  std::unique_ptr<bus::Participant> bus_;
  bus::Publisher<sensor_msgs::msg::Image> color_;
  bus::Publisher<sensor_msgs::msg::Image> depth_;
  bus::Publisher<sensor_msgs::msg::CompressedImage> packed_color_;
  bus::Publisher<sensor_msgs::msg::CompressedImage> packed_depth_;
  bus::Publisher<sensor_msgs::msg::CameraInfo> info_;
  bus::Publisher<sensor_msgs::msg::CameraInfo> depth_info_;
  bus::Publisher<tf2_msgs::msg::TFMessage> static_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string diagnosis_;
  std::vector<rds_msgs::msg::TrackingState> states_;
  std::vector<bus::Subscription> subscriptions_;
  Process tracker_;
};

}  // namespace rds::test
