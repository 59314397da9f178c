// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "common/keyframe_transfer/keyframe_source.hpp"
#include "common/messages/detection_conversions.hpp"
#include "common/service/peers/peers.hpp"
#include "common/service/service.hpp"
#include "rds_msgs/msg/KeyFrameImages.h"
#include "services/detector/detection_source.hpp"
#include "services/detector/detector_service_config.hpp"
#include "vision_msgs/msg/Detection2DArray.h"

namespace rds::detector {

/// Looks at keyframe pictures and publishes what is in them.
class DetectorService : public service::Service {
 public:
  /// @throws DetectorError, std::runtime_error if there is no network or no recording to take boxes from.
  DetectorService(service::ServiceContext& context, const DetectorServiceConfig& config);
  void run(const std::stop_token& stop) override;
  static constexpr std::array kLiveSettings{"score_threshold"};
  /// Takes over what may change while it runs, on its worker.
  void reconfigure(const DetectorServiceConfig& config);

 protected:
  service::CommandOutcome execute(const std::string& verb, const std::string& argument) override;

 private:
  using Keyframe = std::shared_ptr<const rds_msgs::msg::KeyFrameImages>;
  struct Arrival {
    Keyframe keyframe;
    std::chrono::steady_clock::time_point time = std::chrono::steady_clock::now();
  };
  void receive(Keyframe keyframe);
  void take(const Arrival& arrival);
  void look_at(const Arrival& arrival);
  void publish(const std::vector<messages::ImageDetection>& found, const Keyframe& keyframe);

  bool lockstep_;
  service::FollowedWriter tracker_;  // this and its map epoch: of the bus's thread
  std::uint64_t map_epoch_ = 0;
  bool paused_ = false;
  std::unique_ptr<DetectionSource> source_;
  concurrency::Inbox<Arrival> keyframes_;
  bus::Publisher<vision_msgs::msg::Detection2DArray> detections_;
  keyframe_transfer::KeyframeSource<rds_msgs::msg::KeyFrameImages>
      keyframe_source_;  // last: fills the inbox
};

}  // namespace rds::detector
