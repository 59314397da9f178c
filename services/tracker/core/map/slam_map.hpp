// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "services/tracker/core/features/scale_pyramid.hpp"
#include "services/tracker/core/map/keyframe_records.hpp"

namespace rds::tracker {

/// What a map consists of. Everything else is computed from it.
struct MapContents {
  IdTable<Keyframe> keyframes;  // without `covisible`
  IdTable<MapPoint> points;     // without `normal`, `level_0_distance`, `descriptor`
  KeyframeRecords records;
};

/// Keyframes, map points and who sees what. Owned by one thread.
///
/// Invariant: keyframe k's feature f sees point p exactly if p's observations contain (k, f).
class SlamMap {
 public:
  /// @param contents  that fit together (map_of() checks that).
  explicit SlamMap(const ScalePyramid& pyramid, MapContents&& contents = {})
      : pyramid_(pyramid), contents_(std::move(contents)) {}

  [[nodiscard]] Keyframe* keyframe(KeyframeId id) { return contents_.keyframes.find(id); }
  [[nodiscard]] const Keyframe* keyframe(KeyframeId id) const { return contents_.keyframes.find(id); }
  [[nodiscard]] MapPoint* point(PointId id) { return contents_.points.find(id); }
  [[nodiscard]] const MapPoint* point(PointId id) const { return contents_.points.find(id); }
  IdTable<Keyframe>& keyframes() { return contents_.keyframes; }
  [[nodiscard]] const IdTable<Keyframe>& keyframes() const { return contents_.keyframes; }
  IdTable<MapPoint>& points() { return contents_.points; }
  [[nodiscard]] const IdTable<MapPoint>& points() const { return contents_.points; }
  KeyframeRecords& records() { return contents_.records; }
  [[nodiscard]] const KeyframeRecords& records() const { return contents_.records; }
  [[nodiscard]] const ScalePyramid& pyramid() const { return pyramid_; }

  Keyframe& add_keyframe(std::int64_t stamp_ns, const Pose& map_from_camera,
                         std::shared_ptr<const FeatureSet> features);
  /// A new point seen by this feature. @throws std::out_of_range for an unknown keyframe.
  MapPoint& add_point(const Eigen::Vector3d& position, KeyframeId keyframe, std::uint32_t feature);

  /// Lets a free feature see a point. @return false if either is unknown, the feature taken or movable, or
  /// the keyframe sees the point already.
  bool observe(PointId point, KeyframeId keyframe, std::uint32_t feature);
  /// Forgets that a keyframe sees a point; a point that nobody sees any more is erased.
  void forget(PointId point, KeyframeId keyframe);
  void erase_point(PointId point);
  /// Removes a keyframe, unless it is the only one; its pose lives on relative to the covisible keyframe that
  /// shares most points.
  void cull_keyframe(KeyframeId keyframe);

  /// map_from_camera, also of keyframes that are in the records only. @throws std::out_of_range for an
  /// unknown id.
  [[nodiscard]] Pose pose_of(KeyframeId id) const;

 private:
  ScalePyramid pyramid_;
  MapContents contents_;
};

/// Sets the pose of a keyframe, also of one that is in the records only. Points stay.
void set_pose(SlamMap& map, KeyframeId id, const Pose& map_from_camera);

/// All that saw `drop` see `keep`; `drop` is erased.
void merge_points(SlamMap& map, PointId keep, PointId drop);

/// Every keyframe of the map, or of a submap, that ever was, from this one on, by id; also those of which only
/// the pose was kept.
std::vector<KeyframePose> keyframe_poses(const SlamMap& map, KeyframeId first = 0,
                                         SubmapId submap = Submaps::kMap);

}  // namespace rds::tracker
