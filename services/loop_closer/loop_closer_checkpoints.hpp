// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/store/checkpoint_schedule.hpp"
#include "common/store/checkpoint_writer.hpp"
#include "services/loop_closer/core/loop_closer.hpp"

namespace rds::loop_closer {

/// The loop closer's checkpoint: a row "keyframe" for each that was taken, as it was taken, and a row "start"
/// that says with which saved map. Used by one thread.
class LoopCloserCheckpoints {
 public:
  /// @param writer  nullptr: nothing lasts.
  LoopCloserCheckpoints(std::unique_ptr<store::CheckpointWriter> writer, double period_s)
      : writer_(std::move(writer)), schedule_(period_s) {}

  /// @param start  checksum of the part of the saved map that the loop closer begins with; 0 without one.
  void begin_with(std::uint64_t start) { start_ = start; }
  /// Shows all keyframes to a loop closer again, in order. What began with another saved map goes.
  /// @return or why the checkpoint cannot be used.
  tl::expected<void, std::string> restore(LoopCloser& loop_closer);
  /// The last keyframe that restore() has shown.
  struct Last {
    std::uint64_t map_epoch = 0;
    std::uint64_t id = 0;
  };
  [[nodiscard]] const std::optional<Last>& restored() const { return restored_; }

  void add(const KeyframeFeatures& keyframe);
  /// Forgets all.
  void clear();
  /// Hands over what has come since, if it is time. @param now  whether it is time or not.
  void save(bool now = false);

 private:
  void begin_anew();

  std::unique_ptr<store::CheckpointWriter> writer_;
  store::Batch changes_;
  std::optional<std::uint64_t> map_epoch_;
  std::uint64_t start_ = 0;
  std::optional<Last> restored_;
  store::CheckpointSchedule schedule_;
};

}  // namespace rds::loop_closer
