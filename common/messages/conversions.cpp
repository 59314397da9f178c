// SPDX-License-Identifier: Apache-2.0
#include "common/messages/conversions.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace rds::messages {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

Expected<geometry::Pose> checked_pose(const Eigen::Vector3d& translation,
                                      const Eigen::Quaterniond& rotation) {
  if (!translation.allFinite() || !rotation.coeffs().allFinite()) {
    return tl::make_unexpected("the pose contains a value that is not finite");
  }
  const double norm = rotation.norm();
  if (!(norm > 1e-6 && norm < 1e6)) return tl::make_unexpected("the pose has no valid quaternion");
  return geometry::make_pose(translation, rotation);
}

Eigen::Quaterniond quaternion_of(const geometry_msgs::msg::Quaternion& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

geometry_msgs::msg::Quaternion quaternion_message(const geometry::Pose& pose) {
  const Eigen::Quaterniond rotation(pose.linear());
  geometry_msgs::msg::Quaternion message;
  message.x(rotation.x());
  message.y(rotation.y());
  message.z(rotation.z());
  message.w(rotation.w());
  return message;
}

template <class Message>
Message xyz_message(const Eigen::Vector3d& vector) {
  Message message;
  message.x(vector.x());
  message.y(vector.y());
  message.z(vector.z());
  return message;
}

}  // namespace

std::int64_t to_nanoseconds(const builtin_interfaces::msg::Time& time) {
  return time.sec() * kNanosecondsPerSecond + time.nanosec();
}

builtin_interfaces::msg::Time to_time(std::int64_t nanoseconds) {
  std::int64_t seconds = nanoseconds / kNanosecondsPerSecond;
  std::int64_t rest = nanoseconds % kNanosecondsPerSecond;
  if (rest < 0) {
    rest += kNanosecondsPerSecond;
    --seconds;
  }
  using Seconds = std::numeric_limits<std::int32_t>;
  builtin_interfaces::msg::Time time;
  time.sec(static_cast<std::int32_t>(std::clamp<std::int64_t>(seconds, Seconds::min(), Seconds::max())));
  time.nanosec(static_cast<std::uint32_t>(rest));
  return time;
}

std_msgs::msg::Header make_header(std::int64_t stamp_ns, std::string frame_id) {
  std_msgs::msg::Header header;
  header.stamp(to_time(stamp_ns));
  header.frame_id(std::move(frame_id));
  return header;
}

Expected<geometry::Pose> to_pose(const geometry_msgs::msg::Pose& message) {
  const auto& p = message.position();
  return checked_pose({p.x(), p.y(), p.z()}, quaternion_of(message.orientation()));
}

Expected<geometry::Pose> to_pose(const geometry_msgs::msg::Transform& message) {
  const auto& t = message.translation();
  return checked_pose({t.x(), t.y(), t.z()}, quaternion_of(message.rotation()));
}

geometry_msgs::msg::Pose to_pose_message(const geometry::Pose& pose) {
  geometry_msgs::msg::Pose message;
  message.position(xyz_message<geometry_msgs::msg::Point>(pose.translation()));
  message.orientation(quaternion_message(pose));
  return message;
}

geometry_msgs::msg::Transform to_transform_message(const geometry::Pose& pose) {
  geometry_msgs::msg::Transform message;
  message.translation(xyz_message<geometry_msgs::msg::Vector3>(pose.translation()));
  message.rotation(quaternion_message(pose));
  return message;
}

Expected<geometry::CameraModel> to_camera_model(const sensor_msgs::msg::CameraInfo& message) {
  constexpr std::uint32_t kLargestSide = 16384;
  if (message.width() > kLargestSide || message.height() > kLargestSide) {
    return tl::make_unexpected("camera info: width and height must be at most 16384 px");
  }
  const auto& d = message.d();
  const std::string& model = message.distortion_model();
  geometry::CameraModel camera;
  const auto first_unused =
      d.begin() + static_cast<std::ptrdiff_t>(std::min(d.size(), camera.distortion.size()));
  const bool none = std::all_of(d.begin(), d.end(), [](double k) { return k == 0; });
  const bool beyond_k3 = std::any_of(first_unused, d.end(), [](double k) { return k != 0; });
  if (!none && ((model != "plumb_bob" && model != "rational_polynomial") || beyond_k3)) {
    return tl::make_unexpected("camera info: distortion '" + model + "' with " + std::to_string(d.size()) +
                               " coefficients is not supported, expected plumb_bob with k1 k2 p1 p2 k3");
  }
  camera.width = static_cast<int>(message.width());
  camera.height = static_cast<int>(message.height());
  const auto& k = message.k();
  camera.fx = k[0];
  camera.cx = k[2];
  camera.fy = k[4];
  camera.cy = k[5];
  std::copy(d.begin(), first_unused, camera.distortion.begin());
  if (!camera.is_valid()) {
    return tl::make_unexpected("camera info: expected positive size and focal lengths and finite values");
  }
  return camera;
}

sensor_msgs::msg::CameraInfo to_camera_info(const geometry::CameraModel& camera,
                                            std_msgs::msg::Header header) {
  sensor_msgs::msg::CameraInfo message;
  message.header(std::move(header));
  message.width(static_cast<std::uint32_t>(camera.width));
  message.height(static_cast<std::uint32_t>(camera.height));
  message.distortion_model("plumb_bob");
  message.d().assign(camera.distortion.begin(), camera.distortion.end());
  message.k() = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  message.r() = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  message.p() = {camera.fx, 0, camera.cx, 0, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0};
  return message;
}

}  // namespace rds::messages
