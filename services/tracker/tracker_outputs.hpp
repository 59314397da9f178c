// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/geometry/pose.hpp"
#include "common/image/rgbd_frame.hpp"
#include "common/keyframe_transfer/keyframe_sharing.hpp"
#include "common/messages/keyframe_pose_table.hpp"
#include "common/service/service.hpp"
#include "rds_msgs/msg/FrameFeatures.h"
#include "rds_msgs/msg/KeyFrameFeatures.h"
#include "rds_msgs/msg/KeyFrameImages.h"
#include "rds_msgs/msg/KeyFramePoses.h"
#include "rds_msgs/msg/PredictedBoxes.h"
#include "rds_msgs/msg/TrackingState.h"
#include "sensor_msgs/msg/PointCloud2.h"
#include "services/tracker/core/prediction/movable_objects.hpp"
#include "services/tracker/core/tracker.hpp"
#include "services/tracker/odometry/odometry_output.hpp"
#include "services/tracker/odometry/path_output.hpp"

namespace rds::tracker {

/// The loop closer's corrections that the map contains.
struct LoopState {
  std::uint64_t instance = 0;  // of the loop closer; 0: none yet
  std::uint64_t revision = 0;  // counted by that instance
  std::uint32_t loops_closed = 0;
};

/// What is published about one frame.
struct FrameReport {
  const image::RgbdFrame& frame;
  const FrameResult& result;
  std::string camera_frame;  // frame_id of the picture; empty: not known
  std::span<const ImageObject> objects;
  std::uint64_t frame_index = 0;
  std::uint32_t predict_us = 0;
  std::int64_t started_us = 0;  // when the frame was taken [time::now_us()]
  std::uint64_t frames_dropped = 0;
  std::uint64_t box_sets_used = 0;
  LoopState loops = {};
  std::span<const KeyframePose> keyframe_poses = {};  // all, if the frame is a keyframe
};

/// All topics that the tracker writes.
class TrackerOutputs {
 public:
  TrackerOutputs(service::ServiceContext& context, const FramesConfig& frames, std::uint64_t map_epoch);

  /// Odometry, tf, boxes, obstacles, features, keyframe, and last the tracking state, which acknowledges the
  /// frame and tells how long all of it took.
  void publish(const FrameReport& report);

  /// Keyframe poses (source LOCAL), with the next revision: of all of them those that are new or have moved
  /// since the last message; all for somebody who has joined, or if they are to be exact. @return that
  /// revision.
  std::uint64_t publish_poses(std::span<const KeyframePose> poses, const LoopState& loops,
                              bool exact = false);

  /// Keyframe poses of a submap (source SUBMAP), of all of them those that are new or have moved.
  void publish_submap(std::span<const KeyframePose> poses);
  /// A keyframe of the map, to the loop closer; those of a submap once that was joined to the map.
  void publish_features_of(const KeyframeData& keyframe, const FrameReport& report);

  /// True while a new subscriber to poses or path has not got all of them.
  bool has_new_reader();

  OdometryOutput& odometry() { return odometry_; }
  void set_epoch(std::uint64_t map_epoch);

 private:
  /// What was published of it.
  struct PublishedKeyframe {
    rds_msgs::msg::KeyFrameImages images;
    std::optional<rds_msgs::msg::KeyFrameFeatures> features;
  };

  template <class Message>
  [[nodiscard]] Message about(const FrameReport& report, const std::string& frame_id) const;
  [[nodiscard]] const std::string& camera_frame(const FrameReport& report) const;
  void publish_boxes(const FrameReport& report);
  void publish_obstacles(const FrameReport& report);
  void publish_features(const FrameReport& report);
  PublishedKeyframe publish_keyframe(const FrameReport& report);
  rds_msgs::msg::KeyFrameFeatures write_features(const KeyframeData& keyframe, const FrameReport& report);
  void share(PublishedKeyframe&& keyframe);
  void publish_state(const FrameReport& report);

  std::uint64_t instance_;
  std::uint64_t map_epoch_;
  std::string map_frame_;
  std::string submap_frame_;
  std::string default_camera_frame_;
  messages::KeyframePoseChanges pose_changes_;
  messages::KeyframePoseChanges submap_changes_;
  messages::MovedKeyframes moved_;  // since the loop closer was told of a keyframe
  int informed_readers_ = 0;        // subscribers that have got all poses
  OdometryOutput odometry_;
  PathOutput path_;
  bus::Publisher<rds_msgs::msg::TrackingState> state_;
  bus::Publisher<rds_msgs::msg::PredictedBoxes> boxes_;
  bus::Publisher<sensor_msgs::msg::PointCloud2> obstacles_;
  bus::Publisher<rds_msgs::msg::FrameFeatures> features_;
  bus::Publisher<rds_msgs::msg::KeyFrameImages> keyframe_images_;
  bus::Publisher<rds_msgs::msg::KeyFrameFeatures> keyframe_features_;
  bus::Publisher<rds_msgs::msg::KeyFramePoses> keyframe_poses_;
  keyframe_transfer::KeyframeSharing sharing_;
};

}  // namespace rds::tracker
