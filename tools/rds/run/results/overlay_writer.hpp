// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "common/bus/participant.hpp"
#include "common/concurrency/mailbox.hpp"
#include "common/image/rgbd_frame.hpp"
#include "rds_msgs/msg/FrameFeatures.h"
#include "tools/rds/run/results/mjpeg_avi.hpp"
#include "tools/rds/run/results/recorder.hpp"

namespace rds::run {

/// Draws overlay pictures on a thread of its own: every 50th frame as JPEG, every frame into overlay.avi if
/// wanted.
class OverlayWriter {
 public:
  /// @param folder  gets overlay/NNNNNN.jpg and, with `video`, overlay.avi.
  OverlayWriter(bus::Participant& bus, Recorder& recorder, std::filesystem::path folder, bool video,
                double frames_per_second);

  /// The picture of one frame, before or after its features arrive. Shares the pixels.
  void add_picture(std::size_t index, const image::RgbdFrame& frame);

  /// Draws what is left and closes the files. @throws std::runtime_error naming a file that cannot be written.
  void finish();

 private:
  using Features = std::shared_ptr<const rds_msgs::msg::FrameFeatures>;
  struct Picture {
    std::size_t index = 0;
    image::ColorImage color;
  };
  void draw_all(const std::stop_token& stop);
  void draw(const Features& features);
  void draw_or_fail(const Features& features);
  std::optional<Picture> take_picture(std::int64_t stamp_ns);

  Recorder& recorder_;
  std::filesystem::path folder_;
  std::unique_ptr<MjpegAvi> video_;
  std::mutex mutex_;
  std::map<std::int64_t, Picture> pictures_;
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<Features> features_;
  bus::Subscription subscription_;
  std::exception_ptr failure_;  // of the thread, which then draws no more
  std::jthread thread_;  // last: it uses the members above
};

}  // namespace rds::run
