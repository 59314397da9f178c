// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "common/geometry/camera_model.hpp"
#include "common/service/peers/peers.hpp"
#include "common/service/service.hpp"
#include "rds_msgs/msg/KeyFramePoses.h"
#include "sensor_msgs/msg/CameraInfo.h"
#include "services/transformer/core/box_transform.hpp"
#include "services/transformer/first_poses.hpp"
#include "services/transformer/transformer_service_config.hpp"
#include "vision_msgs/msg/Detection2DArray.h"
#include "vision_msgs/msg/Detection3DArray.h"

namespace rds::transformer {

/// Lifts the boxes of a keyframe into the map, as soon as the keyframe's pose and the camera are known.
class TransformerService : public service::Service {
 public:
  TransformerService(service::ServiceContext& context, const TransformerServiceConfig& config);
  void run(const std::stop_token& stop) override;
  static constexpr std::array kLiveSettings{"min_depth_m", "max_depth_m"};
  /// Takes over what may change while it runs, on its worker.
  void reconfigure(const TransformerServiceConfig& config);

 protected:
  service::CommandOutcome execute(const std::string& verb, const std::string& argument) override;

 private:
  using Detections = std::shared_ptr<const vision_msgs::msg::Detection2DArray>;
  using Poses = std::shared_ptr<const rds_msgs::msg::KeyFramePoses>;
  using Info = std::shared_ptr<const sensor_msgs::msg::CameraInfo>;

  void take_pose_messages();
  void take(const Poses& message);
  void take_camera();
  void take_detections();
  void lift_what_is_complete();
  void lift(const Detections& detections, const geometry::Pose& map_from_camera);

  TransformerServiceConfig config_;
  service::FollowedWriter tracker_;
  std::uint64_t map_epoch_ = 0;
  std::optional<geometry::CameraModel> camera_;
  FirstPoses poses_;
  std::deque<Detections> waiting_;
  bool paused_ = false;
  concurrency::Inbox<Detections> detections_inbox_;
  concurrency::Inbox<Poses> poses_inbox_;
  concurrency::Inbox<Info> camera_inbox_;
  bus::Publisher<vision_msgs::msg::Detection3DArray> boxes_;
  std::vector<bus::Subscription> subscriptions_;  // last: callbacks fill the inboxes
};

}  // namespace rds::transformer
