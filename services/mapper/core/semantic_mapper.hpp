// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>

#include "common/time/continuous_time.hpp"
#include "services/mapper/core/keyframe/keyframe_store.hpp"
#include "services/mapper/core/octree/occupancy_grid.hpp"
#include "services/mapper/core/pipeline.hpp"

namespace rds::mapper {

/// The parts of a checkpoint, apart because they change at different times.
struct MapCheckpoint {
  map_file::Bytes state;                               // epoch, labels, what the epoch began with
  std::map<std::uint64_t, map_file::Bytes> keyframes;  // stamps and poses, kIdsPerBlock ids in a block
  std::optional<map_file::Bytes> final_map;  // of the keyframes that are final; nullopt: as the time before
  static constexpr std::uint64_t kIdsPerBlock = 64;
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
  /// Keyframes that are older than the newest of these, by id, and not among them: nothing will move them any
  /// more.
  void make_others_final(std::span<const KeyframePose> told);

  /// Makes the map again from scratch with exactly these poses, in order of keyframe ids.
  MapDelta settle(std::span<const KeyframePose> poses);

  /// Is called between the keyframes of whatever takes long; it must not use the mapper.
  void report_progress_to(std::function<void()> progress) { progress_ = std::move(progress); }

  /// Starts an epoch: with the saved map if there is one, else empty.
  void reset(std::uint64_t map_epoch);

  /// Goes on from a saved map in this epoch, and in those that reset() starts. It stays as it is; later
  /// keyframes are integrated on top. @param tree  without labels and objects, fully expanded.
  /// @return what does not fit; then nothing has changed.
  tl::expected<void, std::string> start_from(octomap::ColorOcTree&& tree);
  /// The same from what to_bytes() gave: with labels, objects and the direction of gravity.
  tl::expected<void, std::string> start_from(std::span<const std::uint8_t> bytes);
  /// The map as it stands, with all that further keyframes need of it; not the keyframes.
  [[nodiscard]] map_file::Bytes to_bytes() const;

  /// What, beside the records in the storage, makes this map again in another process. The storage then has
  /// every record as it is now.
  /// @return nullopt if it could not take one: the checkpoint before still holds.
  [[nodiscard]] std::optional<MapCheckpoint> checkpoint();
  /// Makes the map of a checkpoint again, from the storage's records, with the poses they had. Records that
  /// are not there any more are counted (corrections_lost()).
  /// @return or why not: nothing has changed then. It was damaged, or had begun with another saved map.
  tl::expected<void, std::string> restore(const MapCheckpoint& checkpoint);

  [[nodiscard]] const octomap::ColorOcTree& tree() const { return map_->octree.tree(); }
  [[nodiscard]] std::uint16_t label(const octomap::OcTreeKey& key) const { return map_->octree.label(key); }
  [[nodiscard]] std::vector<MapObject> objects() const;
  [[nodiscard]] const LabelTable& labels() const { return labels_; }
  [[nodiscard]] OccupancyGrid grid() const;
  /// Unit vector against gravity in the map frame, as configured or estimated.
  [[nodiscard]] Eigen::Vector3d up_in_map() const;
  /// Poses the map will have after the next re-integration, by id.
  [[nodiscard]] std::vector<KeyframePose> keyframe_poses() const;
  [[nodiscard]] std::uint64_t map_epoch() const { return map_epoch_; }
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  [[nodiscard]] std::size_t keyframes() const { return keyframes_.size() + final_keyframes_; }
  /// Keyframes that can follow no correction any more because the storage failed: they are final, or, where
  /// it gave back other bytes than it was given, not in the map any more.
  [[nodiscard]] std::size_t corrections_lost() const { return corrections_lost_; }
  [[nodiscard]] const MapperConfig& config() const { return config_; }

 private:
  /// What an epoch starts with.
  struct Start {
    std::shared_ptr<Map> map;
    LabelTable labels;
    std::optional<Eigen::Vector3d> up;  // in the map, if it is known
    std::uint64_t checksum = 0;         // of what it was read from
  };
  struct Keyframe {
    std::int64_t stamp_ns;
    std::int64_t time_ns;            // of clock_
    geometry::Pose pose;             // map_from_camera, newest
    geometry::Pose integrated_pose;  // that the map was made with
  };

  std::shared_ptr<const std::vector<Eigen::Vector3f>> rays_of(const geometry::CameraModel& camera) const;
  /// The record of a keyframe with its newest pose; nullopt if the storage failed.
  [[nodiscard]] std::optional<KeyframeRecord> record_of(std::uint64_t id) const;
  void begin(std::uint64_t map_epoch);
  void take_poses(std::span<const KeyframePose> poses);
  [[nodiscard]] bool moved_enough() const;
  MapDelta rebuild();
  [[nodiscard]] std::int64_t time_of(std::uint64_t id, std::int64_t stamp_ns);
  void set_times();
  void make_final(std::uint64_t id);
  void lose(std::uint64_t id);
  [[nodiscard]] map_file::Bytes final_map_bytes() const;
  void know_surfaces(Map& map) const;
  void take_over_records();
  void keep_within_limits();
  void go_on_from(Start start);
  [[nodiscard]] Map first_map() const { return base_ ? *base_ : Map(config_); }
  [[nodiscard]] MapDelta new_delta() const;

  MapperConfig config_;
  std::function<void()> progress_ = [] {};
  std::uint64_t map_epoch_;
  std::uint64_t revision_ = 0;
  LabelTable labels_;
  std::map<std::uint64_t, Keyframe> keyframes_;
  KeyframeStore records_;             // of keyframes_
  time::ContinuousTime clock_;        // at the newest keyframe
  time::ContinuousTime final_clock_;  // at the newest one that is final, and all before it are
  Start start_;                       // its map is nullptr unless there is a saved one
  std::shared_ptr<Map> base_;  // what is final: the saved map, keyframes beyond the limit; nullptr if nothing
  std::unique_ptr<Map> map_;
  std::size_t final_keyframes_ = 0;
  std::map<std::uint64_t, Keyframe> unsaved_final_;  // that the last checkpoint has as others
  bool has_checkpoint_ = false;                      // since the last reset
  std::size_t corrections_lost_ = 0;
  bool boxes_waiting_ = false;
  Scan scan_;  // scratch
  mutable geometry::CameraModel ray_camera_;
  mutable std::shared_ptr<const std::vector<Eigen::Vector3f>> rays_;
};

}  // namespace rds::mapper
