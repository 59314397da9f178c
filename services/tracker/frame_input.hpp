// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "common/concurrency/mailbox.hpp"
#include "common/service/service.hpp"
#include "common/time/stamp_watch.hpp"
#include "sensor_msgs/msg/CameraInfo.h"
#include "sensor_msgs/msg/Image.h"
#include "services/tracker/input/frame_pairer.hpp"
#include "services/tracker/tracker_service_config.hpp"

namespace rds::tracker {

/// The camera's topics, paired, as an inbox of frames, and how their stamps follow each other. Pictures stay
/// in the messages' memory.
class FrameInput {
 public:
  /// @param lockstep  no frame is dropped, and time breaks at once.
  FrameInput(service::ServiceContext& context, concurrency::Mailbox& mailbox, const CameraTopics& topics,
             bool lockstep);

  [[nodiscard]] concurrency::Inbox<image::RgbdFrame>& frames() { return frames_; }
  [[nodiscard]] const concurrency::Inbox<image::RgbdFrame>& frames() const { return frames_; }
  /// Frames that arrived in full and were not used.
  [[nodiscard]] std::uint64_t dropped() const { return frames_.dropped(); }
  /// Takes each frame's stamp, in order. For the worker.
  [[nodiscard]] time::StampWatch& stamps() { return stamps_; }

 private:
  /// Subscribes to one of the topics. @param convert  makes an expected of a message. @param add  gives what
  /// is in it, and the message, to the pairer.
  template <class Message, class Convert, class Add>
  void subscribe(const std::string& topic, const bus::Qos& qos, Convert convert, Add add);

  service::ServiceContext& context_;
  std::mutex pairer_mutex_;  // bus callbacks of different topics may run at once
  FramePairer pairer_;
  concurrency::Inbox<image::RgbdFrame> frames_;
  time::StampWatch stamps_;
  std::vector<bus::Subscription> subscriptions_;  // last: callbacks use the members above
};

}  // namespace rds::tracker
