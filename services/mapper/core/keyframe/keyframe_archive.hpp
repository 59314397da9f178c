// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <span>

#include <tl/expected.hpp>

#include "common/time/continuous_time.hpp"
#include "services/mapper/core/keyframe/keyframe_store.hpp"

namespace rds::mapper {

/// The rays of the newest camera, made once.
class RayCache {
 public:
  explicit RayCache(const SamplingConfig& config) : config_(config) {}

  std::shared_ptr<const SampledRays> of(const geometry::CameraModel& camera) {
    if (!rays_ || !(camera == camera_)) {
      rays_ = std::make_shared<SampledRays>(camera, config_);
      camera_ = camera;
    }
    return rays_;
  }

 private:
  SamplingConfig config_;
  geometry::CameraModel camera_;
  std::shared_ptr<const SampledRays> rays_;
};

/// A keyframe that can still follow corrections; its record lies in the store.
struct Keyframe {
  std::int64_t stamp_ns = 0;
  std::int64_t time_ns = 0;        // of the archive's ContinuousTime
  geometry::Pose pose;             // map_from_camera, newest
  geometry::Pose integrated_pose;  // that it is in the map with
  std::int64_t integrated_time_ns = 0;
};

/// Stamps and poses of keyframes, as a checkpoint holds them: 64 ids in a block.
using KeyframeBlocks = std::map<std::uint64_t, map_file::Bytes>;

/// What the archive adds to a checkpoint.
struct ArchiveCheckpoint {
  KeyframeBlocks keyframes;      // with those that are final, but not in the checkpoint's final map yet
  std::size_t saved_final = 0;   // keyframes in that map
  bool needs_final_map = false;  // it has to be saved with this checkpoint
};

/// The keyframes of an epoch, by id: records, poses and times. Those beyond the limits become final: they
/// stay in the map as they are, and leave the archive.
class KeyframeArchive {
 public:
  KeyframeArchive(const MapperConfig& config, std::unique_ptr<SpillStorage> storage);

  void clear();
  [[nodiscard]] const std::map<std::uint64_t, Keyframe>& keyframes() const { return keyframes_; }
  [[nodiscard]] std::shared_ptr<const SampledRays> rays_of(const geometry::CameraModel& c) const {
    return rays_.of(c);
  }

  /// Of all keyframes, newest, in order of their ids.
  [[nodiscard]] std::vector<KeyframePose> poses() const;
  /// Keyframes in the map, final ones included.
  [[nodiscard]] std::size_t size() const { return keyframes_.size() + final_keyframes_; }

  /// Adds a record with the pose that it carries, and gives it its time.
  void add(KeyframeRecord& record);
  /// Puts a record in the place of the one with its id.
  void replace(const KeyframeRecord& record) { records_.put(record); }
  /// A keyframe's record with its newest pose; nullopt if the storage failed.
  [[nodiscard]] std::optional<KeyframeRecord> record(std::uint64_t id) const;
  /// Spills records beyond memory_mb. @return a keyframe that must become final, because the storage is full
  /// or there are more than max_keyframes; nullopt if there is none.
  std::optional<std::uint64_t> spill();
  /// Forgets a keyframe that the final map has taken in.
  void make_final(std::uint64_t id);
  /// Forgets a keyframe whose record cannot be had any more.
  void lose(std::uint64_t id);

  /// Takes over poses; unknown ids and poses that are not finite are ignored.
  void set_poses(std::span<const KeyframePose> poses);
  /// Keyframes whose pose or time is not the integrated one, by id.
  [[nodiscard]] std::vector<std::uint64_t> moved() const;
  /// Those whose pose differs by more than 1 cm or 0.5°.
  [[nodiscard]] std::vector<std::uint64_t> moved_enough() const;
  /// Gives all keyframes the times that they would have had, had they come in the order of their ids.
  void set_times();
  /// A keyframe is in the map with its newest pose and time.
  void note_integrated(std::uint64_t id);

  /// Puts all records into the storage, for a checkpoint of which this is the archive's part.
  /// @param has_final_map  whether there is a map of final keyframes.
  /// @return nullopt if a record could not be stored.
  [[nodiscard]] std::optional<ArchiveCheckpoint> save(bool has_final_map);
  /// Reads the keyframes of a checkpoint. @return what is wrong with them.
  static tl::expected<std::map<std::uint64_t, Keyframe>, std::string> from_blocks(
      const KeyframeBlocks& blocks);
  /// Goes on with a checkpoint's keyframes and the records that the storage has of them.
  /// @param labels  of the label table; a record with another label is lost.
  void restore(std::map<std::uint64_t, Keyframe> keyframes, std::size_t final_keyframes, std::size_t labels);

  /// Keyframes that can follow no correction any more because the storage failed: they are final, or, where
  /// it gave back other bytes than it was given, not in the map any more.
  [[nodiscard]] std::size_t lost() const { return lost_; }

 private:
  MapperConfig config_;
  mutable RayCache rays_;
  KeyframeStore records_;
  std::map<std::uint64_t, Keyframe> keyframes_;
  time::ContinuousTime clock_;        // at the newest keyframe
  time::ContinuousTime final_clock_;  // at the newest one that is final, and all before it are
  std::size_t final_keyframes_ = 0;
  std::map<std::uint64_t, Keyframe> unsaved_final_;  // not in the last checkpoint's final map
  bool has_checkpoint_ = false;                      // since the last clear()
  std::size_t lost_ = 0;
};

}  // namespace rds::mapper
