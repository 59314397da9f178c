// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/pose.hpp"
#include "common/image/rgbd_frame.hpp"
#include "common/keyframe_transfer/keyframe_sharing.hpp"
#include "common/messages/keyframe_pose_table.hpp"
#include "common/service/service.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "rds_msgs/msg/FrameFeatures.h"
#include "rds_msgs/msg/KeyFrameFeatures.h"
#include "rds_msgs/msg/KeyFrameImages.h"
#include "rds_msgs/msg/KeyFramePoses.h"
#include "rds_msgs/msg/PredictedBoxes.h"
#include "rds_msgs/msg/TrackingState.h"
#include "services/tracker/core/prediction/movable_objects.hpp"
#include "services/tracker/core/tracker.hpp"
#include "tf2_msgs/msg/TFMessage.h"

namespace rds::tracker {

/// What is published about one frame.
struct FrameReport {
  const image::RgbdFrame& frame;
  const FrameResult& result;
  std::span<const ImageObject> objects;
  std::uint64_t frame_index = 0;
  std::uint32_t predict_us = 0;
  std::uint32_t total_us = 0;  // from when the frame was taken until its result is ready
  std::uint64_t frames_dropped = 0;
  std::uint64_t box_sets_used = 0;
};

/// The loop closer's corrections that the map contains.
struct LoopState {
  std::uint64_t instance = 0;  // of the loop closer; 0: none yet
  std::uint64_t revision = 0;  // counted by that instance
  std::uint32_t loops_closed = 0;
};

/// All topics that the tracker writes. Keeps odom: odom→camera is continuous, map→odom takes the jumps.
class TrackerOutputs {
 public:
  TrackerOutputs(service::ServiceContext& context, std::uint64_t map_epoch);

  /// Odometry, tf, boxes, features, keyframe, and last the tracking state, which acknowledges the frame.
  void publish(const FrameReport& report);

  /// Keyframe poses (source LOCAL), with the next revision: of all of them those that are new or have moved
  /// since the last message; all for somebody who has joined, or if they are to be exact. @return that
  /// revision.
  std::uint64_t publish_poses(std::span<const KeyframePose> poses, const LoopState& loops,
                              bool exact = false);

  /// True once after somebody new has subscribed to the poses: he waits for all of them.
  bool has_new_reader();

  /// The map moved under the camera: the next frame's map→odom takes the jump.
  void move_map(const geometry::Pose& corrected_map_from_map);

  void set_epoch(std::uint64_t map_epoch);

 private:
  void publish_pose(const FrameReport& report);
  void publish_boxes(const FrameReport& report);
  void publish_features(const FrameReport& report);
  void publish_keyframe(const FrameReport& report);
  void publish_state(const FrameReport& report);

  std::uint64_t instance_;
  std::uint64_t map_epoch_;
  messages::KeyframePoseChanges pose_changes_;
  int pose_readers_ = 0;
  bool reader_waits_ = false;
  geometry::Pose map_from_odom_ = geometry::Pose::Identity();
  bus::Publisher<nav_msgs::msg::Odometry> odometry_;
  bus::Publisher<tf2_msgs::msg::TFMessage> tf_;
  bus::Publisher<rds_msgs::msg::TrackingState> state_;
  bus::Publisher<rds_msgs::msg::PredictedBoxes> boxes_;
  bus::Publisher<rds_msgs::msg::FrameFeatures> features_;
  bus::Publisher<rds_msgs::msg::KeyFrameImages> keyframe_images_;
  bus::Publisher<rds_msgs::msg::KeyFrameFeatures> keyframe_features_;
  bus::Publisher<rds_msgs::msg::KeyFramePoses> keyframe_poses_;
  keyframe_transfer::KeyframeSharing sharing_;
};

}  // namespace rds::tracker
