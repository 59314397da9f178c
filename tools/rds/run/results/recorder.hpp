// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <stop_token>
#include <utility>
#include <vector>

#include "common/bus/participant.hpp"
#include "common/concurrency/mailbox.hpp"
#include "common/messages/keyframe_pose_table.hpp"
#include "common/service/peers/peers.hpp"
#include "common/topics/topic.hpp"
#include "rds_msgs/msg/KeyFramePoses.h"
#include "rds_msgs/msg/MapInfo.h"
#include "rds_msgs/msg/PredictedBoxes.h"
#include "rds_msgs/msg/TrackingState.h"
#include "tools/rds/run/results/recording.hpp"
#include "vision_msgs/msg/Detection2DArray.h"

namespace rds::run {

/// Listens to a run (to one tracker, whoever else speaks), keeps its Recording, and tells the player what has
/// been acknowledged.
class Recorder {
 public:
  explicit Recorder(bus::Participant& bus);

  /// Waits until the tracker has acknowledged the frame and its boxes are recorded.
  bool wait_acknowledged(std::int64_t stamp_ns, const std::stop_token& stop, std::chrono::milliseconds limit);

  /// Waits until the mapper is at most `backlog` keyframes behind the tracker.
  bool wait_mapper(std::uint64_t backlog, const std::stop_token& stop, std::chrono::milliseconds limit);

  /// Waits until keyframe poses of at least this revision are recorded.
  bool wait_poses(std::uint64_t revision, const std::stop_token& stop, std::chrono::milliseconds limit);

  /// A copy of what was recorded so far.
  [[nodiscard]] Recording recording() const;
  /// Boxes predicted into one frame.
  [[nodiscard]] std::vector<PredictionRecord> predictions(std::int64_t stamp_ns) const;
  /// The frame's record, if it has been acknowledged.
  [[nodiscard]] std::optional<FrameRecord> frame(std::int64_t stamp_ns) const;
  /// Keyframes of the tracker's epoch so far.
  [[nodiscard]] std::uint64_t keyframes() const;

 private:
  using Clock = std::chrono::steady_clock;
  using Loops = std::map<std::int64_t, std::vector<LoopRecord>>;  // by stamp of the later keyframe
  using LoopKey = std::pair<std::uint64_t, std::uint64_t>;        // the loop closer's instance and revision
  /// Subscribes to what services write in their own name only.
  template <class Message>
  void subscribe(bus::Participant& bus, const topics::Topic<Message>& topic,
                 void (Recorder::*take)(const Message&));
  void on_state(const rds_msgs::msg::TrackingState& message);
  void on_boxes(const rds_msgs::msg::PredictedBoxes& message);
  void on_poses(const rds_msgs::msg::KeyFramePoses& message);
  void on_loops(const rds_msgs::msg::KeyFramePoses& message);
  void on_detections(const vision_msgs::msg::Detection2DArray& message);
  void on_map_info(const rds_msgs::msg::MapInfo& message);
  template <class Ready>
  bool wait(const std::stop_token& stop, std::chrono::milliseconds limit, Ready ready);

  mutable std::mutex mutex_;
  service::InstanceOwners owners_;
  service::FollowedWriter tracker_;
  messages::KeyframePoseTable poses_;
  std::condition_variable_any changed_;
  Recording recording_;
  std::uint64_t first_keyframe_id_ = 0;  // of the epoch; those of a saved map come before it
  std::uint64_t keyframes_ = 0;
  std::optional<std::uint64_t> last_mapped_id_;
  std::map<std::uint64_t, Clock::time_point> unmapped_;  // keyframes by id, and when they came
  std::uint64_t epoch_ = 0;
  std::map<LoopKey, Loops> found_loops_;
  std::set<LoopKey> followed_loops_;              // those that the tracker's poses contain; it refuses others
  std::vector<bus::Subscription> subscriptions_;  // last: callbacks use the members above
};

}  // namespace rds::run
