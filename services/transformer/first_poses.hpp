// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "common/geometry/keyframe_pose.hpp"

namespace rds::transformer {

/// Each keyframe's pose as it was first told: before local bundle adjustment (paper §IV-B), and so
/// independent of how long the detector takes.
///
/// Of two keyframes with one stamp (a recording that is played again) the newer one counts. Where stamps go
/// back from one keyframe to the next, those of before are forgotten: stamps of two times cannot be told
/// apart.
class FirstPoses {
 public:
  /// @param capacity  keyframes; then those with the lowest ids are forgotten.
  explicit FirstPoses(std::size_t capacity) : capacity_(capacity) {}

  /// @param poses  by ascending ids, of some or all keyframes. What is known already, or was, is left alone;
  /// so is an id that cannot have been reached: it would shut out all others.
  void take(std::span<const geometry::KeyframePose> poses);
  /// map_from_camera; nullopt if no keyframe of the stamp is known.
  [[nodiscard]] std::optional<geometry::Pose> of(std::int64_t stamp_ns) const;
  void clear();

 private:
  [[nodiscard]] bool is_impossible(const geometry::KeyframePose& pose) const;
  [[nodiscard]] bool goes_back(const geometry::KeyframePose& pose) const;
  void forget_before(std::uint64_t id);

  std::size_t capacity_;
  std::map<std::uint64_t, geometry::KeyframePose> by_id_;
  std::map<std::int64_t, std::uint64_t> id_of_stamp_;
  std::uint64_t first_id_ = 0;  // all before it are forgotten
};

}  // namespace rds::transformer
