// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <stop_token>
#include <string>

#include "common/bus/participant.hpp"
#include "common/image/recording.hpp"
#include "sensor_msgs/msg/CameraInfo.h"
#include "sensor_msgs/msg/Image.h"
#include "tools/rds/play/sensor_player.hpp"

namespace rds::play {

struct PlayerOptions {
  double rate = 1.0;  // times recorded speed; 0: as fast as `acknowledged` lets it
  std::size_t start = 0;
  std::size_t frames = std::numeric_limits<std::size_t>::max();
  bool loop = false;
  image::RobotSensors sensors = {};  // to play beside the pictures
};

struct PlayerReport {
  std::size_t played = 0;
  std::size_t unreadable = 0;
  std::string first_error;  // of the unreadable frames
};

/// Decodes the first frame that will be played: a recording that is wrong from the start is refused.
/// @throws std::runtime_error with one sentence.
void check_first_frame(const image::Recording& dataset, std::size_t start);

/// Publishes a recording as a camera would: colour, camera_info, and depth registered to colour; an empty
/// depth picture with the same stamp where the recording has none.
///
/// What other sensors have told goes out before the pictures of its time. Pictures are decoded ahead of time
/// by a thread of its own. A frame that cannot be read is skipped and counted.
class Player {
 public:
  /// Called after each frame was sent. At rate 0 the player goes on when it returns. @return false to end.
  using AfterFrame = std::function<bool(const image::RgbdFrame& frame, std::size_t index)>;

  Player(bus::Participant& bus, const image::Recording& dataset, const PlayerOptions& options);

  /// Frames of one pass.
  [[nodiscard]] std::size_t frame_count() const;

  /// Readers that listen to colour now.
  [[nodiscard]] int readers() const { return color_.matched(); }

  PlayerReport run(const std::stop_token& stop, const AfterFrame& after_frame);

 private:
  void publish(const image::RgbdFrame& frame, std::int64_t depth_stamp_ns, std::int64_t shift_ns);

  const image::Recording& dataset_;
  PlayerOptions options_;
  bus::Publisher<sensor_msgs::msg::Image> color_;
  bus::Publisher<sensor_msgs::msg::CameraInfo> camera_info_;
  bus::Publisher<sensor_msgs::msg::Image> depth_;
  SensorPlayer sensors_;
};

}  // namespace rds::play
