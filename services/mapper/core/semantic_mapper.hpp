// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "services/mapper/core/keyframe/keyframe_archive.hpp"
#include "services/mapper/core/saved_map.hpp"
#include "services/mapper/core/scan/contribution.hpp"

namespace rds::mapper {

/// The parts of a checkpoint, apart because they change at different times.
struct MapCheckpoint {
  map_file::Bytes state;     // epoch, labels, what the epoch began with, which object is which
  KeyframeBlocks keyframes;  // stamps and poses
  std::optional<map_file::Bytes> final_map;  // of the keyframes that are final; nullopt: as the time before
};

/// The mapper's core: keyframes and boxes in, semantic octree, objects and their changes out.
///
/// Every keyframe is kept (strided, packed), so that its contribution can be taken out of the map and put in
/// again when its pose or its boxes change: after settle() the map is a pure function of the keyframes, their
/// boxes and the poses given, whatever the order in which they had arrived. The map frame is the frame of the
/// poses. Not thread-safe; deterministic.
class SemanticMapper {
 public:
  /// @param storage  takes keyframes beyond `correction.memory_mb`; without it the oldest become final.
  /// @param memory  of the evidence, which outlasts the mapper; of it only what is near the camera is in use.
  explicit SemanticMapper(MapperConfig config, std::uint64_t map_epoch = 0,
                          std::unique_ptr<SpillStorage> storage = nullptr,
                          std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  /// Adds a keyframe with the pose it carries.
  /// @throws std::invalid_argument if check(input) finds a fault or its id is already there.
  MapDelta integrate(const KeyframeInput& input);

  /// Boxes that arrive after their keyframe, or replace earlier ones; they act at the next apply_poses() or
  /// settle().
  /// @return false if there is no such keyframe, or it has become final.
  bool set_boxes(std::uint64_t keyframe_id, std::span<const LabelledBox> boxes);

  /// Takes over corrected poses. Keyframes that have moved beyond a threshold since they were integrated move
  /// in the map, and late boxes act; other poses are only remembered. Poses of unknown keyframes, and poses
  /// that are not finite, are ignored. At most kMovedAtOnce keyframes move, those nearest to the newest one
  /// first, where the camera is; the rest follows with go_on_correcting().
  /// @return what changed, deletions included; is_noop() if nothing was done.
  MapDelta apply_poses(std::span<const KeyframePose> poses);
  static constexpr std::size_t kMovedAtOnce = 32;  // in a third of a second or so
  /// Whether something of the corrections is left to do, which takes several steps after a large loop.
  [[nodiscard]] bool is_correcting() const { return has_moves_left_ || map_.content->evidence.is_behind(); }
  /// The next step of that. @return as apply_poses().
  MapDelta go_on_correcting();
  /// Makes keyframes final that are older, by id, than the newest of these and not among them: nothing will
  /// move them any more.
  void make_others_final(std::span<const KeyframePose> told);

  /// Makes the map that of exactly these poses, and counts the ids of objects anew.
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
  void add(const KeyframeRecord& record);
  void remove(std::uint64_t id);
  void add_all(const ObjectDatabase& identities);
  void move(std::span<const std::uint64_t> keyframes);
  [[nodiscard]] std::vector<std::uint64_t> nearest_first(std::vector<std::uint64_t> keyframes) const;
  void make_final(std::uint64_t id);
  void lose(std::uint64_t id);
  void spill();
  void make_objects_again(bool keep_ids);
  MapDelta show(bool all = false);
  [[nodiscard]] MapDelta new_delta() const;

  MapperConfig config_;
  std::pmr::memory_resource* memory_;
  SemanticMap map_;
  std::function<void()> progress_ = [] {};
  KeyframeArchive archive_;
  SavedMap saved_;
  std::map<std::uint64_t, ObjectView> object_views_;  // of keyframes that are not final
  ObjectDatabase final_objects_;                      // as those that are have left it
  bool has_final_ = false;                            // the map has parts that are
  bool are_objects_outdated_ = false;
  bool has_moves_left_ = false;  // keyframes whose pose is corrected are in the map with another one
  bool is_hidden_ = false;       // the evidence has changed since it was shown
  Scan scan_;                    // scratch
};

}  // namespace rds::mapper
