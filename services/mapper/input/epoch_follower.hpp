// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "common/service/diagnostics.hpp"
#include "common/service/peers/epoch_confirmation.hpp"
#include "rds_msgs/msg/KeyFrameImages.h"
#include "rds_msgs/msg/KeyFramePoses.h"

namespace rds::mapper {

/// Why a message is not used.
struct Refusal {
  service::Rejection code;
  std::string_view reason;
};

/// Which map epoch counts: one tracker is followed, and of that one its newest epoch. Where there is a map to
/// lose, another epoch begins with its second message only, because a single one may be spoiled; what has
/// come of it until then waits here. Used by one thread.
class EpochFollower {
 public:
  using Clock = std::chrono::steady_clock;
  using Images = std::shared_ptr<const rds_msgs::msg::KeyFrameImages>;
  using Poses = std::shared_ptr<const rds_msgs::msg::KeyFramePoses>;
  /// Whether messages of a writer are used, as service::FollowedWriter::accept().
  using Accepts = std::function<bool(std::uint64_t instance, bool same_map)>;

  explicit EpochFollower(Accepts tracker) : accepts_(std::move(tracker)) {}

  /// A message of a tracker. @param current  the epoch of the map.
  /// @return nullopt if the message is of that epoch, or of another one that may begin.
  std::optional<Refusal> hear_tracker(std::uint64_t instance, std::uint64_t map_epoch, std::uint64_t current,
                                      Clock::time_point now);

  /// A keyframe of another epoch. @return the keyframes with which that one begins; empty: not confirmed yet.
  std::vector<Images> confirm(const Images& keyframe);
  /// The tracker's poses of another epoch. @return its first keyframe, if they confirm that; else nullptr.
  Images confirm(const Poses& poses);
  /// Keeps poses of another epoch for begin(): the first message has all of them, the next ones changes.
  void keep(const Poses& poses);

  /// Another epoch begins. @param over  the one before. @return what keep() was given, in order.
  std::vector<Poses> begin(std::uint64_t over, Clock::time_point now);

 private:
  bool is_over(std::uint64_t map_epoch, Clock::time_point now);

  Accepts accepts_;
  std::uint64_t tracker_ = 0;
  std::deque<std::uint64_t> earlier_;  // epochs of that tracker
  Clock::time_point heard_;            // the newest message of the current epoch
  service::EpochConfirmation next_;
  Images first_of_next_;
  std::vector<Poses> poses_of_next_;
};

}  // namespace rds::mapper
