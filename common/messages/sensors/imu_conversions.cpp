// SPDX-License-Identifier: Apache-2.0
#include "common/messages/sensors/imu_conversions.hpp"

#include <utility>

#include "common/messages/conversions.hpp"

namespace rds::messages {
namespace {

constexpr double kNotMeasured = -1;  // first of a covariance

Eigen::Vector3d to_vector(const geometry_msgs::msg::Vector3& message) {
  return {message.x(), message.y(), message.z()};
}

geometry_msgs::msg::Vector3 to_vector_message(const Eigen::Vector3d& vector) {
  geometry_msgs::msg::Vector3 message;
  message.x(vector.x());
  message.y(vector.y());
  message.z(vector.z());
  return message;
}

}  // namespace

image::ImuMeasurement to_measurement(const sensor_msgs::msg::Imu& message) {
  return {to_nanoseconds(message.header().stamp()), to_vector(message.linear_acceleration()),
          to_vector(message.angular_velocity())};
}

bool has_gyroscope(const sensor_msgs::msg::Imu& message) {
  return message.angular_velocity_covariance()[0] != kNotMeasured;
}

sensor_msgs::msg::Imu to_imu_message(const image::ImuMeasurement& measurement, bool has_gyroscope,
                                     std_msgs::msg::Header header) {
  sensor_msgs::msg::Imu message;
  message.header(std::move(header));
  message.orientation().w(1);
  message.orientation_covariance()[0] = kNotMeasured;
  message.linear_acceleration(to_vector_message(measurement.acceleration));
  message.angular_velocity(to_vector_message(measurement.turn_rate));
  if (!has_gyroscope) message.angular_velocity_covariance()[0] = kNotMeasured;
  return message;
}

}  // namespace rds::messages
