// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "common/dynamic_segmentation/depth_grid.hpp"
#include "services/tracker/core/calibration/self_calibration.hpp"
#include "services/tracker/core/loops/loop_fusion.hpp"
#include "services/tracker/core/map/map_checkpoint.hpp"
#include "services/tracker/core/mapping/keyframe_data.hpp"
#include "services/tracker/core/mapping/local_mapping.hpp"
#include "services/tracker/core/pose/tracking_context.hpp"
#include "services/tracker/core/submaps/submap_joining.hpp"

namespace rds::tracker {

/// Builds and changes the map: inserts keyframes, hands out local mapping jobs and brings their results in.
/// Source: Mur-Artal et al. 2015, §VI.
class LocalMapper {
 public:
  /// @param grows           false: keyframes made here are temporary.
  /// @param keep_all_poses  of keyframes for other services; else the newer ones.
  LocalMapper(const PoseSettings& settings, bool grows, bool keep_all_poses)
      : settings_(settings), grows_(grows), keep_all_poses_(keep_all_poses), map_(settings.pyramid) {}

  SlamMap& map() { return map_; }
  [[nodiscard]] const SlamMap& map() const { return map_; }

  /// Makes the frame a keyframe of the map; frame.points then has the new points, too.
  /// @param images  of the frame; null if points are not followed.
  /// @param cells   of the frame's depth: what late boxes of the keyframe are cut out of.
  KeyframeData insert(TrackedFrame& frame, std::shared_ptr<const ImagePyramid> images,
                      const segmentation::PictureCells& cells);
  /// A keyframe for other services only; a map that grows keeps its pose, relative to `anchor`.
  KeyframePose insert_pose_only(const TrackedFrame& frame, KeyframeId anchor);
  /// Takes a keyframe out of the map if there are too many temporary ones, and the points that it alone sees:
  /// the oldest of them.
  /// @return it; nullopt if there is none.
  std::optional<KeyframeId> cull_temporary();
  /// A keyframe of the map as other services see it. @throws std::out_of_range if it is not there.
  [[nodiscard]] KeyframeData keyframe_data(KeyframeId id) const;
  /// Every keyframe made here that is in the map, by id, also those that are culled; of those for other
  /// services the newer ones.
  [[nodiscard]] std::vector<KeyframePose> keyframe_poses() const;
  /// Depth of a keyframe whose boxes may still come; null if unknown or too old.
  [[nodiscard]] const segmentation::PictureCells* cells_of(KeyframeId keyframe) const;
  /// Takes the features in a late mask of a keyframe out of the map.
  void retract(KeyframeId keyframe, const MovableMask& movable);

  /// Snapshot around the newest keyframe or, where the map does not grow, around a reference keyframe;
  /// nullopt where nothing is due.
  std::optional<LocalMappingJob> take_job(const SelfCalibration& calibration);
  /// Brings a result in. @return the keyframes that were culled then; nullopt if it is outdated.
  std::optional<std::vector<KeyframeId>> apply(const LocalMappingResult& result);
  /// True for a keyframe of the map at least half of whose features show what stands still.
  [[nodiscard]] bool is_mostly_static(KeyframeId keyframe) const;
  /// Moves keyframes to corrected poses and joins what the loops say is one place; then a global adjustment
  /// is due. @return points that were replaced by others; nullopt if the map confirms none of the loops: then
  /// nothing has changed.
  std::optional<ReplacedPoints> correct(std::span<const KeyframePose> corrected,
                                        std::span<const LoopMatch> loops);
  /// Puts a submap into an older one and joins what the sightings say is one place; then a global adjustment
  /// is due. @return as correct(); nullopt, too, if what the two measured contradicts each other.
  std::optional<ReplacedPoints> join(const SubmapMove& move, std::span<const FoundKeyframe> sightings);
  /// Snapshot of the whole map; nullopt where no global adjustment is due.
  std::optional<LocalMappingJob> take_adjustment(const SelfCalibration& calibration);
  /// Brings a global adjustment in. @return false if it is outdated.
  bool apply_adjustment(const LocalMappingResult& result);

  /// Goes on in this map. @param rows_are_known  a checkpoint has its rows.
  void start_from(SlamMap&& map, bool rows_are_known);
  void append_checkpoint(std::vector<CheckpointRow>& rows) { checkpoint_.append_changes(map_, rows); }

 private:
  ReplacedPoints join(std::span<const LoopMatch> loops);
  void remember(const KeyframePose& keyframe);
  void settle_pose(KeyframeId id);
  [[nodiscard]] LocalMappingJob prepared(LocalMappingJob&& job, const SelfCalibration& calibration) const;

  struct KeyframeDepth {
    KeyframeId keyframe = kNoId;
    segmentation::PictureCells cells;
  };

  PoseSettings settings_;
  bool grows_;
  bool keep_all_poses_;
  SlamMap map_;
  MapCheckpoint checkpoint_;
  KeyframeId job_centre_ = kNoId;
  bool adjustment_is_due_ = false;
  std::uint64_t revision_ = 0;          // of the map's geometry, counts corrections
  std::vector<PointId> recent_points_;  // that may still prove bad
  std::deque<KeyframeDepth> depths_;    // of keyframes whose boxes may still come
  std::deque<KeyframePose> outside_;    // keyframes made while the map does not grow, the newest
  std::deque<KeyframeId> temporary_;    // those of them that the map holds, by id
};

}  // namespace rds::tracker
