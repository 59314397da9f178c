// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/play/sensor_player.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "common/topics/endpoints.hpp"
#include "tools/recording/camera_messages.hpp"

namespace rds::play {
namespace {

// Longer than an accelerometer's window, and less than what a topic keeps of an IMU with 800 Hz.
constexpr std::int64_t kBacklogNs = 600'000'000;

/// @param next  the first that was not passed yet; is moved on.
template <class Sample>
std::span<const Sample> through(std::int64_t stamp_ns, const std::vector<Sample>& samples,
                                std::size_t& next) {
  const auto index_at = [&](std::int64_t at_ns) {
    return static_cast<std::size_t>(std::ranges::lower_bound(samples, at_ns, {}, &Sample::stamp_ns) -
                                    samples.begin());
  };
  const std::size_t begin = std::max(next, index_at(stamp_ns - kBacklogNs));
  const std::size_t end = std::min(index_at(stamp_ns) + 1, samples.size());
  if (end <= begin) return {};
  next = end;
  return std::span(samples).subspan(begin, end - begin);
}

}  // namespace

SensorPlayer::SensorPlayer(bus::Participant& bus, image::RobotSensors sensors)
    : sensors_(std::move(sensors)) {
  if (const auto mounting = recording::mounting_message(sensors_)) {
    mounting_ = topics::advertise(bus, topics::kStaticTransforms, topics::kPlayer);
    mounting_.write(*mounting);
  }
  if (sensors_.odometry) odometry_ = topics::advertise(bus, topics::kRobotOdometry, topics::kPlayer);
  if (sensors_.imu) imu_ = topics::advertise(bus, topics::kImu, topics::kPlayer);
}

void SensorPlayer::publish_through(std::int64_t stamp_ns, std::int64_t shift_ns) {
  if (std::exchange(shift_ns_, shift_ns) != shift_ns) next_odometry_ = next_imu_ = 0;
  if (const auto& of = sensors_.odometry)
    for (const auto& pose : through(stamp_ns, of->odom_from_body, next_odometry_))
      odometry_.write(recording::odometry_message(*of, pose.map_from_camera, pose.stamp_ns + shift_ns));
  if (const auto& of = sensors_.imu)
    for (const auto& measurement : through(stamp_ns, of->measurements, next_imu_))
      imu_.write(recording::imu_message(*of, measurement, measurement.stamp_ns + shift_ns));
}

}  // namespace rds::play
