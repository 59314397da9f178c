// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <set>
#include <vector>

#include "common/store/checkpoint_schedule.hpp"
#include "common/store/checkpoint_writer.hpp"
#include "services/mapper/core/semantic_mapper.hpp"
#include "services/mapper/input/keyframe_queue.hpp"

namespace rds::mapper {

/// The mapper's checkpoint: rows "record" (by keyframe), "arrival" (by keyframe), "keyframes" (by block of
/// ids), "state" and "final". Changes gather here, and are handed over together. Used by one thread.
class MapperCheckpoints {
 public:
  /// @param writer  nullptr: nothing lasts.
  MapperCheckpoints(std::unique_ptr<store::CheckpointWriter> writer, double period_s);

  /// Where records go: into the checkpoint; without one nullptr.
  [[nodiscard]] std::unique_ptr<SpillStorage> storage();

  /// Notes a keyframe for the next checkpoint.
  void add(const IntegratedKeyframe& keyframe);
  /// Hands a checkpoint over if it is time. @param now  whether it is time or not.
  void save(SemanticMapper& mapper, bool now = false);
  /// Makes the mapper go on where the checkpoint ends.
  /// @return its keyframes; or why it cannot be used. None where there is none.
  tl::expected<std::vector<IntegratedKeyframe>, std::string> restore(SemanticMapper& mapper);

 private:
  friend class CheckpointedRecords;
  std::unique_ptr<store::CheckpointWriter> writer_;
  store::Batch changes_;  // not handed over yet
  std::set<std::uint64_t> blocks_;
  store::CheckpointSchedule schedule_;
};

}  // namespace rds::mapper
