// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

#include "common/geometry/keyframe_pose.hpp"
#include "common/geometry/pose.hpp"
#include "services/tracker/core/features/feature_set.hpp"
#include "services/tracker/core/features/image_pyramid.hpp"
#include "services/tracker/core/features/scale_pyramid.hpp"
#include "services/tracker/core/map/id_table.hpp"
#include "services/tracker/core/map/map_config.hpp"
#include "services/tracker/core/motion/rolling_shutter.hpp"

namespace rds::tracker {

using geometry::Pose;
using KeyframeId = std::uint64_t;
using PointId = std::uint64_t;
inline constexpr std::uint64_t kNoId = std::numeric_limits<std::uint64_t>::max();
/// Ids from here on are no keyframe's or point's: files that name them are wrong.
inline constexpr KeyframeId kMaxKeyframes = 100'000'000;
inline constexpr PointId kMaxPoints = 2'000'000'000;

/// A feature of a keyframe that sees a map point.
struct Observation {
  KeyframeId keyframe = kNoId;
  std::uint32_t feature = 0;
};

struct MapPoint {
  PointId id = kNoId;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m, map
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    // mean direction from the observing cameras
  double level_0_distance = 0;                         // m; from there it would show at pyramid level 0
  Descriptor descriptor{};                             // nearest to all others of its features
  std::vector<Observation> observations;               // by ascending keyframe, each keyframe once
  KeyframeId created_by = kNoId;
  std::uint32_t visible = 1;       // frames that should have seen it
  std::uint32_t found = 1;         // frames that did
  std::int64_t last_found_ns = 0;  // time of the newest of these
  std::uint64_t mark = 0;          // scratch of whoever walks over points
};

struct CovisibleKeyframe {
  KeyframeId id = kNoId;
  int weight = 0;  // shared map points
};

struct Keyframe {
  KeyframeId id = kNoId;
  std::int64_t stamp_ns = 0;
  std::int64_t time_ns = 0;  // of the tracker's ContinuousTime; the stamp where none is told
  Pose map_from_camera = Pose::Identity();
  ShutterMotion motion;        // that px and depth of the features are compensated for
  double given_fx = 0;         // px, before calibration changed the camera; 0: it is as it is
  bool pose_is_given = false;  // and held by bundle adjustment
  std::shared_ptr<const FeatureSet> features;
  std::shared_ptr<const ImagePyramid> images;  // null if points are not followed, and in a map that was saved
  std::vector<PointId> points;                 // per feature; kNoId
  std::vector<bool> movable;                   // per feature; more than the set knows after late boxes
  std::vector<CovisibleKeyframe> covisible;    // most shared points first, then by id
  int tracked_points = 0;                      // map points that its frame saw when it became a keyframe
};

/// Identity and pose of a keyframe; what outlives its culling.
using geometry::KeyframePose;

/// What stays of every keyframe.
struct KeyframeRecord {
  KeyframeId id = kNoId;
  std::int64_t stamp_ns = 0;
  KeyframeId anchor = kNoId;  // kNoId while the keyframe itself is there
  Pose anchor_from_camera = Pose::Identity();
  bool pose_only = false;  // never was in the map: nothing hangs on it
};

/// What a map consists of. Everything else is computed from it.
struct MapContents {
  IdTable<Keyframe> keyframes;  // without `points` and `covisible`
  IdTable<MapPoint> points;     // without `normal`, `level_0_distance`, `descriptor`
  IdTable<KeyframeRecord> records;
  KeyframeId held = 0;  // keyframes below this id are the gauge
};

/// Keyframes, map points and who sees what. Owned by one thread.
///
/// Invariant: keyframe k's feature f sees point p exactly if p's observations contain (k, f).
class SlamMap {
 public:
  SlamMap(const MapConfig& config, const ScalePyramid& pyramid) : config_(config), pyramid_(pyramid) {}
  /// The map of these contents. @return or what does not fit together: a point that nobody or an unknown
  /// keyframe sees, a feature with two points, a pose that hangs on nothing.
  static tl::expected<SlamMap, std::string> of(MapContents&& contents, const MapConfig& config,
                                               const ScalePyramid& pyramid);

  [[nodiscard]] Keyframe* keyframe(KeyframeId id) { return keyframes_.find(id); }
  [[nodiscard]] const Keyframe* keyframe(KeyframeId id) const { return keyframes_.find(id); }
  [[nodiscard]] MapPoint* point(PointId id) { return points_.find(id); }
  [[nodiscard]] const MapPoint* point(PointId id) const { return points_.find(id); }
  [[nodiscard]] std::size_t keyframes() const { return keyframes_.size(); }
  [[nodiscard]] std::size_t points() const { return points_.size(); }
  /// The id of the point that is made next.
  [[nodiscard]] PointId next_point_id() const { return points_.next_id(); }
  IdTable<MapPoint>& all_points() { return points_; }
  [[nodiscard]] const IdTable<MapPoint>& all_points() const { return points_; }
  IdTable<Keyframe>& all_keyframes() { return keyframes_; }
  [[nodiscard]] const IdTable<Keyframe>& all_keyframes() const { return keyframes_; }
  /// Of every keyframe that ever was; a block is touched when a pose or an anchor in it changes.
  IdTable<KeyframeRecord>& all_records() { return records_; }
  [[nodiscard]] const IdTable<KeyframeRecord>& all_records() const { return records_; }

  Keyframe& add_keyframe(std::int64_t stamp_ns, const Pose& map_from_camera,
                         std::shared_ptr<const FeatureSet> features);
  /// Takes an id for a keyframe that the map does not hold: only its pose is kept, relative to `anchor`.
  /// @return the id. @throws std::out_of_range for an unknown anchor.
  KeyframeId add_pose_only(std::int64_t stamp_ns, const Pose& map_from_camera, KeyframeId anchor);
  /// As add_pose_only(), of a keyframe that never was in the map. Earlier ones of this anchor are forgotten,
  /// as the configuration says: a known place is seen for ever.
  KeyframeId add_passing(std::int64_t stamp_ns, const Pose& map_from_camera, KeyframeId anchor);
  /// Makes the keyframes there are so far the gauge: they are never moved nor culled.
  void fix_keyframes() { held_ = records_.next_id(); }
  /// The id of the first keyframe that fix_keyframes() did not find, and of the one that is made next.
  [[nodiscard]] KeyframeId first_free_keyframe() const { return held_; }
  [[nodiscard]] KeyframeId next_keyframe_id() const { return records_.next_id(); }
  /// Uses up the ids below this one: somebody may know them.
  void skip_keyframe_ids(KeyframeId next);
  [[nodiscard]] bool is_fixed(KeyframeId id) const { return id < held_; }
  /// A new point seen by this feature. @throws std::out_of_range for an unknown keyframe.
  MapPoint& add_point(const Eigen::Vector3d& position, KeyframeId keyframe, std::uint32_t feature);

  /// Lets a free feature see a point. @return false if either is unknown, the feature taken or movable, or
  /// the keyframe sees the point already.
  bool observe(PointId point, KeyframeId keyframe, std::uint32_t feature);
  /// Forgets that a keyframe sees a point; a point that nobody sees any more is erased.
  void forget(PointId point, KeyframeId keyframe);
  void erase_point(PointId point);
  /// All that saw `drop` see `keep`; `drop` is erased.
  void merge(PointId keep, PointId drop);
  /// Computes anew what a point owes to its observations: after it or its observers have moved the normal and
  /// the distance, after other keyframes see it the descriptor too.
  void refresh(MapPoint& point) const;
  void refresh_view(MapPoint& point) const;

  /// Computes a keyframe's covisibility edges from its points, at both ends.
  void update_covisibility(KeyframeId keyframe);
  void update_all_covisibility();

  /// Removes a keyframe; its pose lives on relative to the covisible keyframe that shares most points.
  void cull_keyframe(KeyframeId keyframe);
  /// True once a keyframe with this id was there, culled or not.
  [[nodiscard]] bool knows(KeyframeId id) const { return records_.find(id) != nullptr; }
  /// map_from_camera, also of culled keyframes. @throws std::out_of_range for an unknown id.
  [[nodiscard]] Pose pose_of(KeyframeId id) const;
  /// Stamp, also of culled keyframes. @throws std::out_of_range for an unknown id.
  [[nodiscard]] std::int64_t keyframe_stamp_ns(KeyframeId id) const { return record(id).stamp_ns; }
  /// Sets the pose, also of a culled keyframe. Points stay.
  void set_pose(KeyframeId id, const Pose& map_from_camera);
  /// Every keyframe that ever was, from this one on, by id; also those of which only the pose was kept.
  [[nodiscard]] std::vector<KeyframePose> keyframe_poses(KeyframeId first = 0) const;

 private:
  [[nodiscard]] const KeyframeRecord& record(KeyframeId id) const;
  [[nodiscard]] std::string fault_of(const KeyframeRecord& record) const;
  [[nodiscard]] std::string connect(MapPoint& point);
  void forget_passing(std::int64_t now_ns, KeyframeId anchor);
  void refresh_descriptor(MapPoint& point) const;
  void set_covisible(Keyframe& keyframe, KeyframeId other, int weight) const;

  MapConfig config_;
  ScalePyramid pyramid_;
  IdTable<Keyframe> keyframes_;
  IdTable<MapPoint> points_;
  IdTable<KeyframeRecord> records_;
  std::map<KeyframeId, std::deque<KeyframeId>> passing_;  // by anchor, with pose only, oldest first
  KeyframeId held_ = 0;
};

}  // namespace rds::tracker
