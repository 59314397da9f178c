// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "services/mapper/core/keyframe/keyframe_archive.hpp"
#include "services/mapper/core/saved_map.hpp"

namespace rds::mapper {

/// The parts of a checkpoint, apart because they change at different times.
struct MapCheckpoint {
  map_file::Bytes state;                     // epoch, labels, what the epoch began with
  KeyframeBlocks keyframes;                  // stamps and poses
  std::optional<map_file::Bytes> final_map;  // of the keyframes that are final; nullopt: as the time before
};

/// The mapper's core: keyframes and boxes in, semantic octree, objects and their changes out.
///
/// Every keyframe is kept (strided, packed), so that the map can be made again when poses or boxes change:
/// after settle() it is a pure function of the keyframes, their boxes and the poses given, whatever the order
/// in which they had arrived. The map frame is the frame of the poses. Not thread-safe; deterministic.
class SemanticMapper {
 public:
  /// @param storage  takes keyframes beyond `correction.memory_mb`; without it the oldest become final.
  explicit SemanticMapper(MapperConfig config, std::uint64_t map_epoch = 0,
                          std::unique_ptr<SpillStorage> storage = nullptr);

  /// Adds a keyframe with the pose it carries.
  /// @throws std::invalid_argument if check(input) finds a fault or its id is already there.
  MapDelta integrate(const KeyframeInput& input);

  /// Boxes that arrive after their keyframe, or replace earlier ones; they act at the next apply_poses() or
  /// settle().
  /// @return false if there is no such keyframe, or it has become final.
  bool set_boxes(std::uint64_t keyframe_id, std::span<const LabelledBox> boxes);

  /// Takes over corrected poses. Re-integrates all keyframes when one moved beyond the threshold since it was
  /// integrated, or boxes are waiting; otherwise only remembers the poses. Poses of unknown keyframes, and
  /// poses that are not finite, are ignored.
  /// @return what changed, deletions included; is_noop() if nothing was done.
  MapDelta apply_poses(std::span<const KeyframePose> poses);
  /// Makes keyframes final that are older, by id, than the newest of these and not among them: nothing will
  /// move them any more.
  void make_others_final(std::span<const KeyframePose> told);

  /// Makes the map again from scratch with exactly these poses, in order of keyframe ids.
  MapDelta settle(std::span<const KeyframePose> poses);

  /// Is called between the keyframes of whatever takes long; it must not use the mapper.
  void report_progress_to(std::function<void()> progress) { progress_ = std::move(progress); }

  /// Starts an epoch: with the saved map if there is one, else empty.
  void reset(std::uint64_t map_epoch);

  /// Goes on from a saved map in this epoch, and in those that reset() starts.
  void start_from(SavedMap saved);

  /// What, beside the records in the storage, makes this map again in another process. The storage then has
  /// every record as it is now.
  /// @return nullopt if it could not take one: the checkpoint before still holds.
  [[nodiscard]] std::optional<MapCheckpoint> checkpoint();
  /// Makes the map of a checkpoint again, from the storage's records, with the poses they had. Records that
  /// are not there any more are counted (KeyframeArchive::lost()).
  /// @return or why not: nothing has changed then. It was damaged, or had begun with another saved map.
  tl::expected<void, std::string> restore(const MapCheckpoint& checkpoint);

  [[nodiscard]] const SemanticMap& map() const { return map_; }
  [[nodiscard]] const KeyframeArchive& archive() const { return archive_; }
  /// Unit vector against gravity in the map frame, as configured or estimated.
  [[nodiscard]] Eigen::Vector3d up_in_map() const;

 private:
  MapDelta rebuild();
  void make_final(std::uint64_t id);
  [[nodiscard]] MapDelta new_delta() const;

  MapperConfig config_;
  SemanticMap map_;
  std::function<void()> progress_ = [] {};
  KeyframeArchive archive_;
  SavedMap saved_;
  std::shared_ptr<Map> base_;  // of all that is final: the saved map, keyframes; nullptr if nothing
  bool boxes_waiting_ = false;
  Scan scan_;  // scratch
};

}  // namespace rds::mapper
