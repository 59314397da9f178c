// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <random>

#include "common/image/rgbd_frame.hpp"
#include "sensor_msgs/msg/CameraInfo.h"
#include "sensor_msgs/msg/Image.h"
#include "tests/faults/fault_table.hpp"

namespace rds::test {

/// A camera that publishes frames as `rds play` does, until its fault begins.
class FaultyCamera {
 public:
  FaultyCamera(bus::Participant& bus, const Row& row, const Timing& timing);

  /// Publishes a frame, and what has been held back for long enough.
  /// @param at_s  since the first frame [s of the recording].
  void show(const image::RgbdFrame& frame, std::int64_t depth_stamp_ns, double at_s);

  /// The recording's stamps of those that were sent otherwise.
  [[nodiscard]] const std::map<std::int64_t, std::int64_t>& true_stamps() const { return true_stamps_; }
  /// Of the last frame that was sent.
  [[nodiscard]] std::int64_t last_stamp_ns() const { return last_stamp_ns_; }

 private:
  using Send = std::function<void()>;
  [[nodiscard]] std::int64_t clock_offset_ns(double at_s) const;
  void send(double at_s, Send send);

  Fault fault_;
  Timing timing_;
  std::mt19937 random_;
  bus::Publisher<sensor_msgs::msg::Image> color_;
  bus::Publisher<sensor_msgs::msg::CameraInfo> info_;
  bus::Publisher<sensor_msgs::msg::Image> depth_;
  std::multimap<std::size_t, Send> held_;  // by the frame with which they go
  std::map<std::int64_t, std::int64_t> true_stamps_;
  std::int64_t last_stamp_ns_ = 0;
  std::size_t shown_ = 0;
};

}  // namespace rds::test
