// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "common/concurrency/mailbox.hpp"
#include "common/geometry/camera_model.hpp"
#include "common/geometry/pose.hpp"
#include "common/service/peers/peers.hpp"
#include "common/service/service.hpp"
#include "rds_msgs/msg/KeyFramePoses.h"
#include "services/tracker/delayed_values.hpp"
#include "services/tracker/background/mapping_worker.hpp"
#include "services/tracker/tracker_service_config.hpp"
#include "vision_msgs/msg/Detection3DArray.h"

namespace rds::tracker {

/// A keyframe when it was made; its boxes are lifted into the map with this pose.
struct KeyframeSnapshot {
  std::uint64_t id;
  geometry::Pose camera_from_map;
  geometry::CameraModel camera;
  std::uint64_t place = 0;  // which of the frames of reference, counted, the pose is in
  bool has_depth = true;    // without, no box says nothing: nobody could place one
};

/// What others answer to a keyframe: the transformer its boxes, the loop closer corrected poses, local
/// mapping its result, and after a loop the adjustment of the whole map. They take effect as soon as they are
/// here; in lockstep at the frame agreed on when they were asked for. push() is for any thread, all else for
/// the worker.
class KeyframeAnswers {
 public:
  using Boxes = std::shared_ptr<const vision_msgs::msg::Detection3DArray>;
  using Poses = std::shared_ptr<const rds_msgs::msg::KeyFramePoses>;

  /// In lockstep a keyframe's answers take effect so many frames after its own.
  static constexpr std::uint64_t kMappingAfter = 3;
  static constexpr std::uint64_t kPosesAfter = 10;
  /// … and the adjustment of the map so many frames after its loop took effect.
  static constexpr std::uint64_t kAdjustmentAfter = 30;

  /// @param mailbox       that the worker waits on.
  /// @param mapping_nice  by how much local mapping's thread gives way to others.
  KeyframeAnswers(service::ServiceContext& context, concurrency::Mailbox& mailbox,
                  const LockstepConfig& lockstep, int mapping_nice);

  void push(Boxes boxes) { boxes_inbox_.push(std::move(boxes)); }
  void push(Poses poses) { poses_inbox_.push(std::move(poses)); }
  /// Whether something was pushed; for Mailbox::wait's condition only.
  [[nodiscard]] bool locked_ready() const;
  /// Gives what was pushed to the keyframes that asked for it; refuses poses of other map epochs.
  void sort_in(std::uint64_t map_epoch);

  void ask_for_boxes(std::int64_t stamp_ns, const KeyframeSnapshot& snapshot, std::uint64_t frame);
  void ask_for_poses(std::uint64_t keyframe, std::uint64_t frame);
  void ask_for_mapping(LocalMappingJob job, std::uint64_t frame);
  /// An adjustment that runs is stopped and counts no more.
  void ask_for_adjustment(LocalMappingJob job, std::uint64_t frame);

  /// In lockstep: waits until all that takes effect at this frame is here; for other processes as long as the
  /// settings allow.
  /// @param beat  called now and then meanwhile.
  void await(std::uint64_t frame, std::uint64_t map_epoch, const std::stop_token& stop,
             const std::function<void()>& beat);
  /// Whether nothing is asked for.
  [[nodiscard]] bool empty() const;
  [[nodiscard]] bool is_mapping() const { return !mappings_.empty(); }

  /// What takes effect at this frame.
  std::vector<LocalMappingResult> take_mappings(std::uint64_t frame) { return take(mappings_, frame); }
  std::vector<LocalMappingResult> take_adjustments(std::uint64_t frame) { return take(adjustments_, frame); }
  std::vector<Poses> take_poses(std::uint64_t frame) { return take(poses_, frame); }
  std::vector<Boxes> take_boxes(std::uint64_t frame) { return take(boxes_, frame); }
  /// Of the keyframe with this stamp, once; nullopt if it is not known.
  std::optional<KeyframeSnapshot> take_snapshot(std::int64_t stamp_ns);

  void forget_boxes();
  void clear();

 private:
  template <class T>
  std::vector<T> take(DelayedValues<T>& values, std::uint64_t frame) {
    return lockstep_.enabled ? values.take_due(frame) : values.take_arrived();
  }

  service::Diagnostics& diagnostics_;
  concurrency::Mailbox& mailbox_;
  service::FollowedWriter loop_closer_;
  LockstepConfig lockstep_;
  concurrency::Inbox<Boxes> boxes_inbox_;
  concurrency::Inbox<Poses> poses_inbox_;
  concurrency::Inbox<LocalMappingResult> mapping_inbox_;
  concurrency::Inbox<LocalMappingResult> adjustment_inbox_;
  DelayedValues<Boxes> boxes_;                          // by keyframe stamp
  DelayedValues<Poses> poses_;                          // by keyframe id
  DelayedValues<LocalMappingResult> mappings_;          // by keyframe id; at most one
  DelayedValues<LocalMappingResult> adjustments_;       // by revision of the map; at most one
  std::map<std::int64_t, KeyframeSnapshot> snapshots_;  // by stamp, of keyframes whose boxes have not come
  MappingWorker mapping_worker_;                        // last, with the next: they fill the inboxes
  AdjustmentWorker adjustment_worker_;
};

}  // namespace rds::tracker
