// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "common/concurrency/mailbox.hpp"
#include "common/service/service.hpp"
#include "sensor_msgs/msg/CameraInfo.h"
#include "sensor_msgs/msg/Image.h"
#include "services/tracker/input/frame_pairer.hpp"
#include "services/tracker/tracker_service_config.hpp"

namespace rds::tracker {

/// The camera's topics, paired, as an inbox of frames. Pictures stay in the messages' memory.
class FrameInput {
 public:
  FrameInput(service::ServiceContext& context, concurrency::Mailbox& mailbox, const CameraTopics& topics,
             std::size_t capacity);

  [[nodiscard]] concurrency::Inbox<image::RgbdFrame>& frames() { return frames_; }
  [[nodiscard]] const concurrency::Inbox<image::RgbdFrame>& frames() const { return frames_; }
  /// Frames that arrived in full and were not used.
  [[nodiscard]] std::uint64_t dropped() const { return frames_.dropped(); }

 private:
  void on_camera_info(const sensor_msgs::msg::CameraInfo& message);
  void on_color(const std::shared_ptr<const sensor_msgs::msg::Image>& message);
  void on_depth(const std::shared_ptr<const sensor_msgs::msg::Image>& message);
  void push(FramePairer::Frames frames);

  service::ServiceContext& context_;
  CameraTopics topics_;
  std::mutex pairer_mutex_;  // bus callbacks of different topics may run at once
  FramePairer pairer_;
  concurrency::Inbox<image::RgbdFrame> frames_;
  std::vector<bus::Subscription> subscriptions_;  // last: callbacks use the members above
};

}  // namespace rds::tracker
