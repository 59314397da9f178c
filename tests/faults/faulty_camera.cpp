// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/faulty_camera.hpp"

#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"

namespace rds::test {
namespace {

constexpr const char* kFrameId = "camera_color_optical_frame";
constexpr std::int64_t kStepNs = 1'000'000'000'000;
constexpr double kLost = 0.4;
constexpr std::uint32_t kLate = 3;  // 0 … 2 frames

}  // namespace

FaultyCamera::FaultyCamera(bus::Participant& bus, const Row& row, const Timing& timing)
    : fault_(row.fault),
      timing_(timing),
      random_(static_cast<std::uint32_t>(row.index)),
      color_(bus.advertise<sensor_msgs::msg::Image>("camera/color/image_raw", bus::kSensor)),
      info_(bus.advertise<sensor_msgs::msg::CameraInfo>("camera/color/camera_info", bus::kSensor)),
      depth_(
          bus.advertise<sensor_msgs::msg::Image>("camera/aligned_depth_to_color/image_raw", bus::kSensor)) {}

std::int64_t FaultyCamera::clock_offset_ns(double at_s) const {
  if (at_s < timing_.at_s) return 0;
  return fault_ == Fault::kClockBack ? -kStepNs : fault_ == Fault::kClockAhead ? kStepNs : 0;
}

/// Sends now, later or never.
void FaultyCamera::send(double at_s, Send send) {
  const bool disturbed = at_s >= timing_.at_s && at_s < timing_.at_s + timing_.lasts_s;
  if (disturbed && fault_ == Fault::kCameraGap) return;
  const double chance = static_cast<double>(random_()) / static_cast<double>(std::mt19937::max());
  if (disturbed && fault_ == Fault::kFramesLost && chance < kLost) return;
  const bool late = disturbed && fault_ == Fault::kFramesMixed;
  held_.emplace(shown_ + (late ? random_() % kLate : 0), std::move(send));
}

void FaultyCamera::show(const image::RgbdFrame& frame, std::int64_t depth_stamp_ns, double at_s) {
  const std::int64_t offset_ns = clock_offset_ns(at_s);
  last_stamp_ns_ = frame.stamp_ns + offset_ns;
  if (offset_ns != 0) true_stamps_[last_stamp_ns_] = frame.stamp_ns;
  const auto header = messages::make_header(last_stamp_ns_, kFrameId);
  const auto depth_header = messages::make_header(depth_stamp_ns + offset_ns, kFrameId);
  send(at_s,
       [this, camera = frame.camera, header] { info_.write(messages::to_camera_info(camera, header)); });
  send(at_s,
       [this, color = frame.color, header] { color_.write(messages::to_image_message(color, header)); });
  send(at_s, [this, depth = frame.depth, depth_header] {
    depth_.write(messages::to_image_message(depth, depth_header));
  });
  while (!held_.empty() && held_.begin()->first <= shown_) held_.extract(held_.begin()).mapped()();
  ++shown_;
}

}  // namespace rds::test
