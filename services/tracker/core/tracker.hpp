// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "common/image/rgbd_frame.hpp"
#include "common/time/continuous_time.hpp"
#include "services/tracker/core/localizer.hpp"
#include "services/tracker/core/map/map_bytes.hpp"
#include "services/tracker/core/map/map_drift.hpp"
#include "services/tracker/core/mapping/local_mapper.hpp"
#include "services/tracker/core/motion/gyroscope_prior.hpp"
#include "services/tracker/core/motion/odometry_prior.hpp"
#include "services/tracker/core/removal/movable_segmenter.hpp"
#include "services/tracker/core/submaps/submap_joining.hpp"

namespace rds::tracker {

/// map_from_camera at a time [ns], known from elsewhere (a robot's odometry, a motion capture); nullopt where
/// it is not.
using GivenPoses = std::function<std::optional<Pose>(std::int64_t stamp_ns)>;
using Picture = std::shared_ptr<const ImagePyramid>;

/// What the tracker gets from outside of its core.
struct TrackerPorts {
  GivenPoses given_poses = {};           // what the camera's poses are; if empty they are estimated
  Executor executor = execute_serially;  // runs what can be done at the same time
  Stopwatch now_us = [] { return std::int64_t{0}; };  // for the times in results, which are 0 without
  RobotOdometry odometry = {};                        // of the robot; if empty there is none
  Gyroscope gyroscope = {};                           // likewise
};

/// A submap that is part of an older one from now on.
struct JoinedSubmap {
  SubmapId submap = 0;
  std::vector<KeyframeId> placed;  // its keyframes, by id, if the older one is the map; but for culled ones
};

/// RGB-D tracking against a map of ORB features that it builds.
///
/// Owned by one thread. Local mapping is a pure function on a snapshot: take_mapping_job() after a keyframe,
/// run_local_mapping() on any thread, apply() here at a later frame. Poses of frames are kept relative to
/// their reference keyframe, so that applying a result moves the camera with the map and causes no jump.
/// With given poses the map is made as usual, but no pose is estimated or moved.
/// Where vision loses the camera, the robot's odometry carries its pose on while it is trusted
/// (OdometryPrior). Who is lost for config.submap_after_s begins a submap: a map beside the map, in a frame
/// of its own, that join_submaps() puts in its place once it is known. Where stamps go back, time goes on
/// (ContinuousTime): the camera is lost, until it has found itself in the map. With config.localize_only
/// keyframes are temporary: the oldest leave the map again, and those that it started from stay. Same calls,
/// same results, bit by bit.
class Tracker {
 public:
  explicit Tracker(const TrackerConfig& config, TrackerPorts ports = {});

  /// Tracks the next picture.
  ///
  /// @param movable  features in these regions are dropped and never become map points.
  /// @return state and pose; a frame that could not be localised has state kLost (kNotInitialized before the
  /// first keyframe) and no pose, or state kWeak and the pose that trusted odometry carries on; without a
  /// pose is, with given poses, a frame that none is given for. Pictures that are
  /// empty, of other sizes or types than promised count as pictures without features.
  FrameResult track(const image::RgbdFrame& given, std::span<const segmentation::ObjectRegion> movable);

  /// Snapshot around the newest keyframe of the map or, after a keyframe for other services only, around its
  /// reference keyframe; nullopt if neither was made since the last call. Also indexes the newest keyframe
  /// for relocalisation: best called after the frame's result was sent, which does not wait for that.
  std::optional<LocalMappingJob> take_mapping_job();
  /// A keyframe reads its picture elsewhere from now on. @param now  the same pixels. Nothing happens if its
  /// picture is not `before`: it is another map's keyframe.
  void move_picture(KeyframeId keyframe, const Picture& before, Picture now);
  /// Moves keyframes and points; removes, fuses and adds observations. What has changed since the snapshot
  /// is left alone.
  void apply(const LocalMappingResult& result);
  /// Moves keyframes to corrected poses; keyframes that the correction does not know move with the next
  /// older one that it knows, points with the keyframe that made them. Points that both sides of a loop see
  /// are fused. Given poses are not corrected.
  /// @return false if the map confirms none of the loops: then nothing has changed.
  bool correct(std::span<const KeyframePose> corrected, std::span<const LoopMatch> loops = {});
  /// Snapshot of the whole map after a loop has joined it, for run_global_adjustment() on any thread; nullopt
  /// where none has since the last call. A newer one makes those before outdated.
  std::optional<LocalMappingJob> take_adjustment_job();
  /// Moves keyframes and points to where the adjustment puts them; what was made since moves along.
  /// @return false if it is outdated.
  bool apply_adjustment(const LocalMappingResult& result);
  /// Looks for the newest keyframe in other submaps, while there are any. Where enough keyframes agree on how
  /// two submaps lie to each other, the younger one becomes part of the older one; then a global adjustment
  /// is due. Takes 6 … 9 ms, 35 where two are joined; best called after the frame's result was sent.
  /// @return what has been joined; nullopt if nothing has.
  std::optional<JoinedSubmap> join_submaps();
  /// Late boxes of a keyframe: its features in them are taken out of the map.
  void retract_movable(std::uint64_t keyframe_id, std::span<const segmentation::ObjectRegion> regions);

  /// Goes on in a saved map: lost until it has found itself there. An empty map is as after reset().
  void start_from(SavedMap&& saved);

  /// Which way is up in the next picture's camera, if an accelerometer says so: a map that begins with it is
  /// level by that, not by floors and walls. A setting goes before both.
  void set_up(const std::optional<Eigen::Vector3d>& up_in_camera) { localizer_.set_up(up_in_camera); }
  /// Keyframes are made as often as that from now on.
  void set_keyframes(const KeyframeConfig& config) { keyframes_.set(config); }
  /// Somebody says where the camera is: if it is lost, it looks there, too, until it is found.
  /// @return whether it is lost.
  bool seek(const SoughtPlace& place);
  /// What is known of the robot's odometry.
  [[nodiscard]] const OdometryPrior& odometry() const { return odometry_; }
  /// What is known of its gyroscope.
  [[nodiscard]] const GyroscopePrior& gyroscope() const { return gyroscope_; }

  /// What may have changed since the last call, as rows of a checkpoint; all of it the first time, and after
  /// another map has begun. Best called after the frame's result was sent.
  std::vector<CheckpointRow> checkpoint();
  /// Goes on where the rows of checkpoint() end: with the same map and what is known of the
  /// camera, lost until it has found itself there. Ids that were given since are not given again.
  /// @return or why not; then everything is as before.
  tl::expected<void, std::string> resume(const ReadRows& read);

  /// Every keyframe of the map since the last reset, by id, also those that are culled, and of those that
  /// never were in the map the newer ones; without those of a map that it started from.
  [[nodiscard]] std::vector<KeyframePose> keyframe_poses() const { return mapper_.keyframe_poses(); }
  /// Those of a submap.
  [[nodiscard]] std::vector<KeyframePose> keyframe_poses(SubmapId submap) const {
    return tracker::keyframe_poses(mapper_.map(), mapper_.map().records().first_free(), submap);
  }
  /// A keyframe of the map as other services see it. @throws std::out_of_range if it is not there.
  [[nodiscard]] KeyframeData keyframe_data(KeyframeId id) const { return mapper_.keyframe_data(id); }
  [[nodiscard]] const SlamMap& map() const { return mapper_.map(); }
  /// That the camera is, or was last, in.
  [[nodiscard]] SubmapId submap() const { return submap_; }
  /// Keyframes that a lost camera can find itself by.
  [[nodiscard]] std::size_t known_places() const { return localizer_.relocalizer().places(); }
  /// What is known of the camera beyond what it was given with.
  [[nodiscard]] const SelfCalibration& calibration() const { return calibration_; }
  /// Where the camera is given or the motion model expects it; its last pose before there is a motion,
  /// identity before there is a pose.
  [[nodiscard]] Pose expected_camera_from_map(std::int64_t stamp_ns) const;
  /// Pose of the last frame that had one, as the map stands now; identity before that.
  [[nodiscard]] Pose last_map_from_camera() const;
  /// True when the camera has been lost, in pictures that were searched for it, for longer than this map was
  /// ever tracked in, and the map is young: reset() loses little then. Never of a map that was saved, nor
  /// with given poses.
  [[nodiscard]] bool has_lost_young_map(std::int64_t stamp_ns) const;
  /// Forgets everything.
  void reset();

 private:
  void prepare(const image::RgbdFrame& given, std::span<const segmentation::ObjectRegion> regions,
               TrackingContext& context);
  void make_keyframe(KeyframeNeed need, TrackedFrame& frame, FrameResult& result);
  void finish(const TrackingContext& context, TrackedFrame&& frame);
  void expect_by_gyroscope(std::int64_t stamp_ns, TrackingContext& context);
  void expect_by_odometry(std::int64_t stamp_ns, TrackingContext& context);
  static void carry_on(const CarriedPose& carried, TrackedFrame& frame, FrameResult& result);
  void compare_with_odometry(const Pose& map_from_camera);
  [[nodiscard]] Pose sure_map_from_camera() const;
  void forget_depth();
  void forget_depth_where_moved(const Pose& last_before);
  [[nodiscard]] std::optional<double> tracked_s() const;
  [[nodiscard]] double lost_s(std::int64_t time_ns) const;
  [[nodiscard]] bool is_submap_due(std::int64_t time_ns) const;
  void enter(SubmapId submap);

  /// What the tracker is given besides pictures.
  /// A pose that moves with the map.
  struct PlacedPose {
    KeyframeId reference = kNoId;
    Pose reference_from_camera = Pose::Identity();
  };

  TrackerConfig config_;
  TrackerPorts ports_;
  SelfCalibration calibration_;
  MovableSegmenter removal_;
  MotionModel motion_;
  OdometryPrior odometry_;
  GyroscopePrior gyroscope_;
  PlacedPose sure_;  // that the odometry's window began with
  Localizer localizer_;
  KeyframeSelector keyframes_;
  LocalMapper mapper_;
  MapDrift drift_;
  SubmapSightings sightings_;
  SubmapId submap_ = Submaps::kMap;  // that the camera is in
  KeyframeId searched_ = kNoId;      // newest keyframe that was looked for in other submaps
  time::ContinuousTime time_;
  State state_ = State::kNotInitialized;
  std::optional<std::int64_t> lost_since_ns_;  // not while odometry carries on in the dark
};

}  // namespace rds::tracker
