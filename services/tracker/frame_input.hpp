// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "common/concurrency/mailbox.hpp"
#include "common/image/registration/picture_registration.hpp"
#include "common/service/service.hpp"
#include "common/time/stamp_watch.hpp"
#include "services/tracker/input/camera_faults.hpp"
#include "services/tracker/input/frame_pairer.hpp"
#include "services/tracker/tracker_service_config.hpp"
#include "std_msgs/msg/Header.h"

namespace rds::tracker {

/// The camera's topics, paired, as an inbox of frames, and how their stamps follow each other. Pictures of
/// rgb8, bgr8, 16UC1 and 32FC1 stay in the messages' memory; all others are made, and depth of another camera
/// is registered, on their topic's thread of the bus. Four times a second a thread of its own looks who
/// publishes what: where nobody publishes pictures as they are, compressed ones are read, and what is wrong
/// with the camera is told by diagnostics.
class FrameInput {
 public:
  /// @param lockstep  no frame is dropped, and time breaks at once. @param look_up  as tf says; any thread.
  FrameInput(service::ServiceContext& context, concurrency::Mailbox& mailbox, const CameraTopics& topics,
             bool lockstep, image::PictureRegistration::LookUp look_up);

  [[nodiscard]] concurrency::Inbox<image::RgbdFrame>& frames() { return frames_; }
  [[nodiscard]] const concurrency::Inbox<image::RgbdFrame>& frames() const { return frames_; }
  /// Frames that arrived in full and were not used.
  [[nodiscard]] std::uint64_t dropped() const { return frames_.dropped(); }
  /// Takes each frame's stamp, in order. For the worker.
  [[nodiscard]] time::StampWatch& stamps() { return stamps_; }
  /// frame_id of the newest colour picture, before it of its camera_info; empty before both.
  [[nodiscard]] std::string camera_frame() const;

 private:
  using Clock = std::chrono::steady_clock;
  using Taken = tl::expected<void, std::string>;

  /// One of the topics: its names, and when something came that could, or could not, be used.
  struct Stream {
    std::string topic;
    Clock::time_point used = {};
    Clock::time_point refused = {};
    std::string refusal = {};
    std::string packed_topic = {};  // of `packed`
    bus::Subscription raw = {};
    bus::Subscription packed = {};
  };

  /// @param convert  makes an expected of a message. @param take  gives what is in it to the pairer.
  template <class Message, class Convert, class Take>
  bus::Subscription read(Stream& stream, const std::string& topic, Convert convert, Take take);
  void read_packed(Stream& stream, const std::string& topic);
  void choose_packing(Stream& stream, const std::vector<std::string>& packed_topics,
                      const std::vector<bus::DiscoveredEndpoint>& endpoints);
  Taken take_info(const std_msgs::msg::Header& header, const geometry::Lens& lens);
  Taken take_color(const std_msgs::msg::Header& header, image::ColorImage picture);
  Taken take_depth(const std_msgs::msg::Header& header, image::DepthImage picture);
  void pass_on(FramePairer::Frames frames);  // under the lock
  void look();
  [[nodiscard]] StreamSight sight_of(const Stream& stream, const std::string& type,
                                     const std::vector<bus::DiscoveredEndpoint>& endpoints) const;
  [[nodiscard]] CameraSight sight(const std::vector<bus::DiscoveredEndpoint>& endpoints) const;
  void add_others(const std::vector<bus::DiscoveredEndpoint>& endpoints, CameraSight& sight) const;
  void tell_figures();

  service::ServiceContext& context_;
  CameraTopics topics_;
  bus::Qos qos_;  // of the streams
  mutable std::mutex mutex_;  // bus callbacks of different topics may run at once; of all below but frames_
  image::PictureRegistration registration_;
  FramePairer pairer_;
  std::int64_t told_offset_ns_ = 0;
  Clock::time_point framed_;  // when a colour and a depth picture last made a frame
  std::map<std::string, std::string> faults_;
  concurrency::Inbox<image::RgbdFrame> frames_;
  time::StampWatch stamps_;
  FaultFilter filter_;  // of the watcher
  Stream info_;         // callbacks use the members above
  Stream depth_info_;
  Stream color_;
  Stream depth_;
  std::jthread watcher_;  // last: it uses the others
};

}  // namespace rds::tracker
