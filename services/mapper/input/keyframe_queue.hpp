// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "common/geometry/camera_model.hpp"
#include "common/geometry/pose.hpp"
#include "rds_msgs/msg/KeyFrameImages.h"
#include "vision_msgs/msg/Detection3DArray.h"

namespace rds::mapper {

/// A keyframe that is in the map; its boxes may come later.
struct IntegratedKeyframe {
  std::uint64_t id = 0;
  std::int64_t stamp_ns = 0;
  geometry::Pose camera_from_map = geometry::Pose::Identity();  // when the keyframe was made
  geometry::CameraModel camera;
  bool has_boxes = false;  // false: also where it is not known
};

/// How long a keyframe waits for its boxes.
struct BoxesWait {
  bool expected = true;   // false: not at all
  bool lockstep = false;  // until they have come, or later ones: boxes come in the order of the keyframes
  double timeout_s =
      1;  // otherwise until a keyframe newer by this has come, or no newer one for kLongestWait
};

/// Brings keyframes together with their boxes, by their stamps: keyframes wait in the order of their ids,
/// boxes wait for their keyframe. When full, the oldest keyframe is dropped and counted, or the boxes that
/// came first: stamps say nothing about age where a clock was set, or in messages of strangers. Used by one
/// thread, size() and dropped() by any.
class KeyframeQueue {
 public:
  using Clock = std::chrono::steady_clock;
  using Images = std::shared_ptr<const rds_msgs::msg::KeyFrameImages>;
  using Boxes = std::shared_ptr<const vision_msgs::msg::Detection3DArray>;
  struct Entry {
    Images images;
    Boxes boxes;  // nullptr: none have come
  };

  /// @param capacity  keyframes, at least 1.
  KeyframeQueue(std::size_t capacity, const BoxesWait& wait) : capacity_(capacity), wait_(wait) {}

  /// Where the camera stands still no newer keyframe comes: several times as long as a detector needs.
  static constexpr std::chrono::seconds kLongestWait{5};

  /// From now on, where boxes are expected and there is no lockstep: BoxesWait::timeout_s.
  void wait_for_boxes(double timeout_s) { wait_.timeout_s = timeout_s; }

  /// A keyframe that waits or is integrated already changes nothing.
  void add(const Images& images, Clock::time_point now = Clock::now());
  /// Boxes wait for their keyframe, in place of others of its stamp. Those of an integrated keyframe that has
  /// its own are of one that is still to come (a recording that is played again). @return the keyframe for
  /// which they come too late, because it is integrated; nullptr if they wait.
  const IntegratedKeyframe* add(const Boxes& boxes);

  [[nodiscard]] bool empty() const { return keyframes_.empty(); }
  /// Whether the oldest keyframe has waited for its boxes long enough.
  [[nodiscard]] bool is_ready(Clock::time_point now = Clock::now()) const;
  /// There must be one.
  Entry take_oldest();
  /// Of keyframes with one stamp (a recording that is played again), later boxes are of the newest.
  void note_integrated(const IntegratedKeyframe& keyframe) {
    integrated_.insert_or_assign(keyframe.stamp_ns, keyframe);
  }

  /// Forgets the keyframes, not the boxes.
  void forget_keyframes();
  void forget_boxes_before(std::int64_t stamp_ns);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  struct Newest {
    std::uint64_t id;
    std::int64_t stamp_ns;
    Clock::time_point came;
  };
  using StampedBoxes = std::pair<std::int64_t, Boxes>;

  Boxes take_boxes(std::int64_t stamp_ns);

  std::size_t capacity_;
  BoxesWait wait_;
  std::map<std::uint64_t, Images> keyframes_;              // by id
  std::optional<Newest> newest_;                           // that has come, also if it waits no more
  std::deque<StampedBoxes> boxes_;                         // in the order in which they came
  std::map<std::int64_t, IntegratedKeyframe> integrated_;  // by stamp
  std::atomic<std::size_t> size_ = 0;
  std::atomic<std::uint64_t> dropped_ = 0;
};

}  // namespace rds::mapper
