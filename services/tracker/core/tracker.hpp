// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "common/image/rgbd_frame.hpp"
#include "common/time/continuous_time.hpp"
#include "common/vision/place_index.hpp"
#include "services/tracker/core/calibration/self_calibration.hpp"
#include "services/tracker/core/features/orb_extractor.hpp"
#include "services/tracker/core/map/local_map.hpp"
#include "services/tracker/core/map/map_bytes.hpp"
#include "services/tracker/core/map/map_checkpoint.hpp"
#include "services/tracker/core/map/slam_map.hpp"
#include "services/tracker/core/mapping/keyframe_policy.hpp"
#include "services/tracker/core/mapping/local_mapping.hpp"
#include "services/tracker/core/motion/rolling_shutter.hpp"
#include "services/tracker/core/motion/se3.hpp"
#include "services/tracker/core/pose/association.hpp"
#include "services/tracker/core/pose/point_following.hpp"
#include "services/tracker/core/removal/movable_cut.hpp"
#include "services/tracker/core/tracker_config.hpp"
#include "services/tracker/core/tracking_types.hpp"

namespace rds::tracker {

/// map_from_camera at a time [ns], known from elsewhere (a robot's odometry, a motion capture); nullopt where
/// it is not.
using GivenPoses = std::function<std::optional<Pose>(std::int64_t stamp_ns)>;

/// RGB-D tracking against a map of ORB features that it builds.
///
/// Owned by one thread. Local mapping is a pure function on a snapshot: take_mapping_job() after a keyframe,
/// run_local_mapping() on any thread, apply() here at a later frame. Poses of frames are kept relative to
/// their reference keyframe, so that applying a result moves the camera with the map and causes no jump.
/// With given poses the map is made as usual, but no pose is estimated or moved.
/// Where stamps go back, time goes on (ContinuousTime): the camera is lost, until it has found itself in the
/// map. With config.localize_only nothing enters the map; keyframes are then only looked at by others. Same
/// calls, same results, bit by bit.
class Tracker {
 public:
  /// @param given_poses  what the camera's poses are; if empty they are estimated.
  /// @param run_parts    runs what can be done at the same time.
  explicit Tracker(const TrackerConfig& config, GivenPoses given_poses = {},
                   RunParts run_parts = run_in_turn);

  /// Tracks the next picture.
  ///
  /// @param movable  features in these regions are dropped and never become map points.
  /// @return state and pose; a frame that could not be localised has state kLost (kNotInitialized before the
  /// first keyframe) and no pose; so has, with given poses, a frame that none is given for. Pictures that are
  /// empty, of other sizes or types than promised count as pictures without features.
  FrameResult track(const image::RgbdFrame& given, std::span<const MovableRegion> movable);

  /// Snapshot around the newest keyframe, or around the reference keyframe where a calm frame only was
  /// looked at; nullopt if there is neither since the last call. Best called when the frame's result is on
  /// its way: also does what else a keyframe needs and its own frame does not wait for (else the next call
  /// does).
  std::optional<LocalMappingJob> take_mapping_job();
  /// Moves keyframes and points; removes, fuses and adds observations. What has changed since the snapshot
  /// is left alone.
  void apply(const LocalMappingResult& result);
  /// Moves keyframes to corrected poses; keyframes that the correction does not know and all points move
  /// with the keyframes they hang on. Given poses are not corrected.
  void apply(const PoseGraphCorrection& correction);
  /// Late boxes of a keyframe: its features in them are taken out of the map.
  void retract_movable(std::uint64_t keyframe_id, std::span<const MovableRegion> regions);

  /// Goes on in a saved map: lost until it has found itself there. An empty map is as after reset().
  void start_from(SavedMap&& saved);

  /// What may have changed since the last call, as rows of a checkpoint; all of it the first time, and after
  /// another map has begun. Best called when the frame's result is on its way.
  std::vector<CheckpointRow> checkpoint();
  /// Goes on where the rows end that checkpoint() has told: with the same map and what is known of the
  /// camera, lost until it has found itself there. Ids that were given since are not given again.
  /// @return or why not; then everything is as before.
  tl::expected<void, std::string> resume(const ReadRows& read);

  /// Every keyframe since the last reset, by id, also those that are culled, and of those that never were in
  /// the map the newer ones; without those of a map that it started from.
  [[nodiscard]] std::vector<KeyframePose> keyframe_poses() const;
  [[nodiscard]] const SlamMap& map() const { return map_; }
  /// Keyframes that a lost camera can find itself by.
  [[nodiscard]] std::size_t known_places() const { return places_.size() + (unindexed_ != kNoId ? 1 : 0); }
  /// What is known of the camera beyond what it was given with.
  [[nodiscard]] const SelfCalibration& calibration() const { return calibration_; }
  [[nodiscard]] KnownCamera known_camera() const { return {given_fx_, calibration_.focal_scale()}; }
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
  static constexpr int kSureInliers = 80;  // with fewer a pose may be wrong, and another way to it find more

  struct LastFrame {
    TrackedFrame frame;
    std::shared_ptr<const ImagePyramid> images;
    KeyframeId reference = kNoId;
    Pose reference_from_camera = Pose::Identity();
  };
  /// What a new frame should see.
  struct Surroundings {
    std::optional<Pose> camera_from_map;  // by the last frame's points or by the motion model
    std::optional<Pose> aligned;          // by the last frame's points, where no hand would move it so
    std::vector<PointId> points;          // of the last frame and of the local map around it
    KeyframeId reference = kNoId;
    std::optional<PointSearch> search;  // for the points, where they can be followed
  };
  struct FollowedFrame {
    TrackedFrame frame;
    std::vector<PointId> looked_for;
    std::shared_ptr<const FeatureSet>
        extracted;  // of the same picture, if it was looked at for features, too
  };
  struct KeyframeDepth {
    KeyframeId keyframe = kNoId;
    PictureCells cells;
  };
  struct KnownView {
    KeyframeId keyframe = kNoId;
    double change = std::numeric_limits<double>::infinity();  // from there, as view_change() says
  };

  /// False where poses are not estimated or nothing is to be followed.
  [[nodiscard]] bool follows_points() const { return config_.following.enabled && !given_poses_; }
  [[nodiscard]] bool removes_by_depth() const { return config_.removal.method == "depth"; }
  [[nodiscard]] bool teaches_calibration(KeyframeId id) const;
  [[nodiscard]] image::RgbdFrame calibrated(const image::RgbdFrame& given);
  void go_to(std::int64_t stamp_ns);
  void look_at(const image::RgbdFrame& picture);
  void guess_pose(const image::RgbdFrame& picture, Surroundings& around) const;
  void look_around(Surroundings& around);
  [[nodiscard]] std::vector<Eigen::Vector3f> lasting_points(const Surroundings& around) const;
  void look(const image::RgbdFrame& given, const image::RgbdFrame& picture, Surroundings& around);
  [[nodiscard]] MovableMask cut_movable(const image::RgbdFrame& picture,
                                        std::span<const MovableRegion> regions, Surroundings& around);
  KeyframeNeed find_pose(const image::RgbdFrame& picture, Surroundings& around, const MovableMask& movable,
                         TrackedFrame& frame, FrameResult& result);
  KeyframeNeed track_features(const image::RgbdFrame& picture, const MovableMask& movable,
                              TrackedFrame& frame, FrameResult& result);
  void extract(const image::RgbdFrame& picture, const MovableMask& movable, TrackedFrame& frame,
               FrameResult& result);
  void set_features(const image::RgbdFrame& picture, std::vector<Feature>&& features,
                    TrackedFrame& frame) const;
  [[nodiscard]] Pose align_with_last(const image::RgbdFrame& picture) const;
  [[nodiscard]] bool can_follow(const Surroundings& around) const;
  [[nodiscard]] PointSearch search_around(const image::RgbdFrame& picture, const Surroundings& around,
                                          const Pose& guess) const;
  [[nodiscard]] std::optional<FollowedFrame> follow_points(const image::RgbdFrame& picture,
                                                           PointSearch& search, const Pose& guess,
                                                           const MovableMask& movable,
                                                           const TrackedFrame& begun) const;
  [[nodiscard]] std::optional<FollowedFrame> follow_map(const image::RgbdFrame& picture, Surroundings& around,
                                                        const MovableMask& movable,
                                                        const TrackedFrame& begun) const;
  bool accept(FollowedFrame& followed, KeyframeId reference);
  KeyframeNeed follow_with_keyframe(const image::RgbdFrame& picture, const MovableMask& movable,
                                    std::shared_ptr<const FeatureSet> features, TrackedFrame& frame,
                                    FrameResult& result);
  void take_over(const TrackedFrame& followed, const image::RgbdFrame& picture, TrackedFrame& frame) const;
  void initialize(TrackedFrame& frame, FrameResult& result);
  void follow(TrackedFrame& frame, FrameResult& result);
  void associate(TrackedFrame& frame);
  State track_motion(TrackedFrame& frame);
  int track_from_last(TrackedFrame& frame);
  bool estimate_from_last_frame(TrackedFrame& frame);
  bool estimate_from_keyframe(TrackedFrame& frame);
  [[nodiscard]] std::optional<Twist> motion_to(const TrackedFrame& frame) const;
  [[nodiscard]] bool has_jumped(const TrackedFrame& frame) const;
  [[nodiscard]] double jerk(const TrackedFrame& frame) const;
  [[nodiscard]] double jerk(const Pose& camera_from_map, std::int64_t time_ns) const;
  [[nodiscard]] double support(const TrackedFrame& frame) const;
  [[nodiscard]] std::optional<Pose> pose_by_depth(std::int64_t time_ns) const;
  bool find_around(const Pose& by_depth, TrackedFrame& frame);
  State hold(const Pose& by_depth, TrackedFrame& frame);
  bool relocalize(TrackedFrame& frame);
  int refine_with_local_map(TrackedFrame& frame, double window_factor);
  void remember(TrackedFrame&& frame, State state);
  [[nodiscard]] ShutterMotion shutter_motion(std::int64_t time_ns) const;
  [[nodiscard]] Pose expected_at(std::int64_t time_ns) const;
  [[nodiscard]] double since_last_s(std::int64_t time_ns) const;
  void count_found(const TrackedFrame& frame);
  void note_found(int expected, int found, FoundShare& share, TrackedFrame& frame);
  [[nodiscard]] KeyframeNeed keyframe_need(const TrackedFrame& frame) const;
  void add_keyframe(KeyframeNeed need, TrackedFrame& frame, FrameResult& result);
  void make_keyframe(TrackedFrame& frame, FrameResult& result);
  void index_newest_keyframe();
  void index_all_keyframes();
  void show_keyframe(const TrackedFrame& frame, FrameResult& result);
  [[nodiscard]] KnownView nearest_view(const TrackedFrame& frame) const;
  void add_facts_of_map(const TrackedFrame& frame, KeyframeFacts& facts) const;
  [[nodiscard]] KeyframeFacts keyframe_facts(const TrackedFrame& frame, double view_change) const;

  TrackerConfig config_;
  GivenPoses given_poses_;
  RunParts run_parts_;
  ScalePyramid pyramid_;
  OrbExtractor extractor_;
  MovableCut cut_;
  SlamMap map_;
  MapCheckpoint map_checkpoint_;
  SelfCalibration calibration_;
  double given_fx_ = 0;                 // px, of the newest picture; another one is another camera
  KeyframeId calibrated_with_ = kNoId;  // the newest that calibration has learned from
  vision::PlaceIndex places_;
  FoundShare found_by_matching_;
  FoundShare found_by_following_;
  time::ContinuousTime clock_;
  std::int64_t time_ns_ = 0;                    // on clock_, of the frame that is tracked
  std::shared_ptr<const ImagePyramid> images_;  // of the frame that is tracked
  std::optional<LastFrame> last_;               // the last frame with a pose
  std::optional<Twist> velocity_;  // of the camera, per second: camera_from_map moves by exp(v·dt)
  State state_ = State::kNotInitialized;
  KeyframeId reference_ = kNoId;
  KeyframeId newest_keyframe_ = kNoId;            // of those made here
  std::deque<KeyframePose> shown_;                // keyframes that did not enter the map, by id; the newest
  std::uint64_t shown_count_ = 0;                 // all
  std::uint64_t revision_ = 0;                    // of the map's geometry, counts corrections
  std::optional<std::int64_t> last_keyframe_ns_;  // time, of those shown too
  int frames_since_keyframe_ = 0;
  KeyframeId followed_view_ = kNoId;  // keyframe with the view nearest to the last followed frame's
  int covered_at_view_ = 0;       // cells of the picture with followed points when that became the nearest
  KeyframeId unindexed_ = kNoId;  // keyframe that is not in places_ yet
  KeyframeId mapping_centre_ = kNoId;  // where local mapping is due
  bool changed_ = false;
  std::int64_t weak_since_ns_ = 0;
  std::optional<std::int64_t> lost_since_ns_;
  std::uint64_t mark_ = 0;
  std::deque<KeyframeDepth> depth_of_keyframes_;  // of those whose boxes may still come
  std::vector<PointId> recent_points_;
};

}  // namespace rds::tracker
