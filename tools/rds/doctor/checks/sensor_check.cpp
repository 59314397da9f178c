// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/sensor_check.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "services/tracker/core/motion/gyroscope_buffer.hpp"
#include "services/tracker/core/motion/odometry_buffer.hpp"

namespace rds::doctor {
namespace {

constexpr std::size_t kTenths = 10;
constexpr std::size_t kEnoughTenths = 9;  // of the frames

template <class Sample>
std::vector<std::int64_t> stamps_of(const std::vector<Sample>& samples) {
  std::vector<std::int64_t> stamps;
  for (const Sample& sample : samples) stamps.push_back(sample.stamp_ns);
  return stamps;
}

}  // namespace

Finding check_sensor(const std::string& subject, std::span<const std::int64_t> frames,
                     std::span<const std::int64_t> measurements, std::int64_t max_gap_ns) {
  const auto is_covered = [&](std::int64_t frame_ns) {
    const auto after = std::ranges::lower_bound(measurements, frame_ns);
    if (after == measurements.end()) return false;
    return *after == frame_ns || (after != measurements.begin() && *after - *std::prev(after) <= max_gap_ns);
  };
  const auto covered = static_cast<std::size_t>(std::ranges::count_if(frames, is_covered));
  return {kTenths * covered < kEnoughTenths * frames.size() ? Verdict::kHint : Verdict::kGood, subject,
          fmt::format("{} measurements; {} of {} frames lie between two that are at most {} ms apart",
                      measurements.size(), covered, frames.size(), max_gap_ns / 1'000'000)};
}

std::vector<Finding> check_sensors(const image::Recording& recording) {
  std::vector<Finding> findings;
  const auto frames = stamps_of(recording.frames());
  if (const auto& odometry = recording.sensors().odometry)
    findings.push_back(check_sensor("odometry", frames, stamps_of(odometry->odom_from_body),
                                    tracker::OdometryBuffer::kMaxGapNs));
  if (const auto& imu = recording.sensors().imu)
    findings.push_back(
        check_sensor("IMU", frames, stamps_of(imu->measurements), tracker::GyroscopeBuffer::kMaxGapNs));
  return findings;
}

}  // namespace rds::doctor
