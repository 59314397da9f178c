// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "common/store/checkpoint_schedule.hpp"
#include "common/store/checkpoint_writer.hpp"
#include "services/tracker/core/tracker.hpp"
#include "services/tracker/tracker_outputs.hpp"

namespace rds::tracker {

/// The tracker's checkpoint: the rows of Tracker::checkpoint(), and a row "epoch". Used by one thread.
class TrackerCheckpoints {
 public:
  /// What the rows belong to.
  struct Epoch {
    std::uint64_t map_epoch = 0;
    std::uint64_t start = 0;  // checksum of the saved map that the settings name; 0 without one
    LoopState loops;          // that the map contains
  };

  /// @param writer  nullptr: nothing lasts.
  TrackerCheckpoints(std::unique_ptr<store::CheckpointWriter> writer, double period_s)
      : writer_(std::move(writer)), schedule_(period_s) {}

  /// Makes the tracker go on where the checkpoint ends, if that began with the same saved map.
  /// @return its epoch; nullopt where there is none to go on in. Or why it cannot be used.
  tl::expected<std::optional<Epoch>, std::string> restore(std::uint64_t start, Tracker& tracker);

  store::CheckpointSchedule& schedule() { return schedule_; }
  [[nodiscard]] bool is_due() const { return writer_ && schedule_.is_due(); }
  /// Hands over what has changed since. Costs what the camera saw since, or the map if all of it moved.
  void save(Tracker& tracker, const Epoch& epoch);
  /// Another map begins; the rows of this one become the previous checkpoint.
  void clear();

 private:
  std::unique_ptr<store::CheckpointWriter> writer_;
  store::Batch changes_;  // not handed over yet
  store::CheckpointSchedule schedule_;
};

}  // namespace rds::tracker
