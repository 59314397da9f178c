// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <tl/expected.hpp>

#include "builtin_interfaces/msg/Time.h"
#include "common/geometry/camera_model.hpp"
#include "common/geometry/lens.hpp"
#include "common/geometry/pose.hpp"
#include "geometry_msgs/msg/Pose.h"
#include "geometry_msgs/msg/Transform.h"
#include "sensor_msgs/msg/CameraInfo.h"
#include "std_msgs/msg/Header.h"

namespace rds::messages {

template <class T>
using Expected = tl::expected<T, std::string>;

std::int64_t to_nanoseconds(const builtin_interfaces::msg::Time& time);

/// @param nanoseconds  beyond the range of the message's 32-bit seconds they saturate.
builtin_interfaces::msg::Time to_time(std::int64_t nanoseconds);

std_msgs::msg::Header make_header(std::int64_t stamp_ns, std::string frame_id);

/// @return an error for values that are not finite or a quaternion of length zero; the rotation is
/// normalised.
Expected<geometry::Pose> to_pose(const geometry_msgs::msg::Pose& message);
Expected<geometry::Pose> to_pose(const geometry_msgs::msg::Transform& message);

geometry_msgs::msg::Pose to_pose_message(const geometry::Pose& pose);
geometry_msgs::msg::Transform to_transform_message(const geometry::Pose& pose);

/// A lens without distortion or of "plumb_bob", "rational_polynomial" or "equidistant" (also "fisheye") distortion; a
/// rational one without k4 to k6 is a plumb bob.
/// @return or an error: sizes, focal lengths, values that are not finite, more coefficients than the model has.
Expected<geometry::Lens> to_lens(const sensor_msgs::msg::CameraInfo& message);

/// Lens::camera() of to_lens(): the camera of its pictures, resampled where the lens is not plain.
Expected<geometry::CameraModel> to_camera_model(const sensor_msgs::msg::CameraInfo& message);

/// With K, P = [K 0], R = identity and "plumb_bob" distortion.
sensor_msgs::msg::CameraInfo to_camera_info(const geometry::CameraModel& camera,
                                            std_msgs::msg::Header header);

}  // namespace rds::messages
