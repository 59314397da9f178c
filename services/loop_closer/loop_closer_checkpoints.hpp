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

  /// Shows all keyframes to a loop closer again, in order. What began with another saved map goes.
  /// @param start  checksum of the saved map's part, 0 without one.
  /// @return the last one's epoch and id; nullopt if there is none. Or why the checkpoint cannot be used.
  struct Last {
    std::uint64_t map_epoch = 0;
    std::uint64_t id = 0;
  };
  tl::expected<std::optional<Last>, std::string> restore(std::uint64_t start, LoopCloser& loop_closer);

  void add(const KeyframeFeatures& keyframe);
  /// Forgets all. @param start  as for restore().
  void clear(std::uint64_t start);
  /// Hands over what has come since, if it is time. @param now  whether it is time or not.
  void save(bool now = false);

 private:
  std::unique_ptr<store::CheckpointWriter> writer_;
  store::Batch changes_;
  std::optional<std::uint64_t> map_epoch_;
  std::uint64_t start_ = 0;
  store::CheckpointSchedule schedule_;
};

}  // namespace rds::loop_closer
