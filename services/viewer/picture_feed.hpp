// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "common/concurrency/mailbox.hpp"
#include "common/keyframe_codec/jpeg_codec.hpp"
#include "common/service/service.hpp"
#include "rds_msgs/msg/FrameFeatures.h"
#include "sensor_msgs/msg/Image.h"
#include "services/viewer/core/board/board.hpp"
#include "services/viewer/viewer_service_config.hpp"

namespace rds::viewer {

/// The camera's picture with the features that were found in it, as JPEG, a few times a second. Listens to
/// pictures only while somebody looks at them.
class PictureFeed {
 public:
  /// @param notify  called when something has come (bus threads).
  PictureFeed(service::ServiceContext& context, const ViewerServiceConfig& config, Board& board,
              concurrency::Mailbox& mailbox, std::function<void()> notify);

  /// @param hz  pictures a second, at most. @param quality  1 to 100, of JPEG.
  void set(double hz, int quality);
  /// Begins or ends to listen.
  void want(bool wanted);
  /// Puts on the board what is complete.
  void take();

 private:
  using Clock = std::chrono::steady_clock;
  using Image = std::shared_ptr<const sensor_msgs::msg::Image>;
  using Features = std::shared_ptr<const rds_msgs::msg::FrameFeatures>;

  void subscribe();
  void receive(Image image);
  void put(std::int64_t stamp_ns, const Image& image, const rds_msgs::msg::FrameFeatures* features);

  service::ServiceContext& context_;
  std::string topic_;
  std::atomic<Clock::duration> period_;
  Board& board_;
  std::function<void()> notify_;
  keyframe_codec::JpegCompressor compressor_;
  std::atomic<Clock::time_point> last_ = Clock::time_point();  // a picture was kept
  std::map<std::int64_t, Image> waiting_;                      // for their features, by stamp; at most two
  concurrency::Inbox<Image> images_;
  concurrency::Inbox<Features> features_;
  std::optional<bus::Subscription> image_subscription_;  // last: callbacks fill the inboxes
  std::optional<bus::Subscription> feature_subscription_;
};

}  // namespace rds::viewer
