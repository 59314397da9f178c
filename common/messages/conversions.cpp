// SPDX-License-Identifier: Apache-2.0
#include "common/messages/conversions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
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

struct Distortion {
  std::string_view name;
  geometry::LensModel model;
  std::size_t coefficients;
};

// Tried in this order: what a simpler model says is said by it.
constexpr std::array<Distortion, 5> kDistortions{{{"plumb_bob", geometry::LensModel::kPlumbBob, 5},
                                                  {"rational_polynomial", geometry::LensModel::kPlumbBob, 5},
                                                  {"rational_polynomial", geometry::LensModel::kRationalPolynomial, 8},
                                                  {"equidistant", geometry::LensModel::kEquidistant, 4},
                                                  {"fisheye", geometry::LensModel::kEquidistant, 4}}};

/// nullptr if none of them has these coefficients; those beyond a model's own must be zero. A camera that says none at
/// all has no distortion, whatever model it names.
const Distortion* find_distortion(const sensor_msgs::msg::CameraInfo& message) {
  const auto& d = message.d();
  if (d.empty()) return kDistortions.data();
  const auto is_zero_from = [&d](std::size_t first) {
    return std::all_of(d.begin() + static_cast<std::ptrdiff_t>(std::min(first, d.size())), d.end(),
                       [](double c) { return c == 0; });
  };
  const auto* found = std::ranges::find_if(kDistortions, [&](const Distortion& distortion) {
    return distortion.name == message.distortion_model() && is_zero_from(distortion.coefficients);
  });
  if (found != kDistortions.end()) return &*found;
  return is_zero_from(0) ? kDistortions.data() : nullptr;
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

Expected<geometry::Lens> to_lens(const sensor_msgs::msg::CameraInfo& message) {
  constexpr std::uint32_t kLargestSide = 16384;
  if (message.width() > kLargestSide || message.height() > kLargestSide) {
    return tl::make_unexpected("camera info: width and height must be at most 16384 px");
  }
  const auto distortion = find_distortion(message);
  if (distortion == nullptr) {
    return tl::make_unexpected("camera info: distortion '" + message.distortion_model() + "' with " +
                               std::to_string(message.d().size()) +
                               " coefficients, expected plumb_bob with at most 5, rational_polynomial with 8 or "
                               "equidistant with 4");
  }
  const auto& k = message.k();
  geometry::Lens lens{.width = static_cast<int>(message.width()),
                      .height = static_cast<int>(message.height()),
                      .fx = k[0],
                      .fy = k[4],
                      .cx = k[2],
                      .cy = k[5],
                      .model = distortion->model};
  const auto& d = message.d();
  std::copy_n(d.begin(), std::min(d.size(), distortion->coefficients), lens.coefficients.begin());
  const bool finite = std::ranges::all_of(lens.coefficients, [](double c) { return std::isfinite(c); });
  if (!finite || !lens.camera().is_valid()) {
    return tl::make_unexpected("camera info: expected positive size and focal lengths and finite values");
  }
  return lens;
}

Expected<geometry::CameraModel> to_camera_model(const sensor_msgs::msg::CameraInfo& message) {
  return to_lens(message).map([](const geometry::Lens& lens) { return lens.camera(); });
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
