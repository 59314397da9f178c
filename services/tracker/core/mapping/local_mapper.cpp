// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/local_mapper.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "services/tracker/core/mapping/global_adjustment.hpp"
#include "services/tracker/core/mapping/map_building.hpp"
#include "services/tracker/core/mapping/mapping_exchange.hpp"
#include "services/tracker/core/submaps/submap_fit.hpp"

namespace rds::tracker {
namespace {

constexpr std::size_t kAwaitingBoxes = 30;  // keyframes whose boxes may still come
constexpr std::size_t kOutside = 1000;      // keyframes that are remembered where the map does not grow
constexpr std::size_t kTemporary = 60;      // of them in the map: a room or two

KeyframeData data_of(const SlamMap& map, const Keyframe& keyframe) {
  KeyframeData data;
  data.id = keyframe.id;
  data.stamp_ns = keyframe.stamp_ns;
  data.map_from_camera = keyframe.map_from_camera;
  data.features.reserve(keyframe.points.size());
  for (std::size_t i = 0; i < keyframe.points.size(); ++i)
    data.features.push_back(
        {(*keyframe.features)[i], keyframe.features->point_in_camera(i).cast<float>(),
         keyframe.points[i] == kNoId ? -1 : static_cast<std::int64_t>(keyframe.points[i])});
  for (const CovisibleKeyframe& c : keyframe.covisible)
    data.covisible.push_back({c.id, c.weight, map.pose_of(c.id)});
  return data;
}

}  // namespace

KeyframeData LocalMapper::insert(TrackedFrame& frame, std::shared_ptr<const ImagePyramid> images,
                                 const segmentation::PictureCells& cells) {
  const PointId first_new = map_.points().next_id();
  Keyframe& keyframe = insert_keyframe(map_, frame, settings_.depth);
  frame.points = keyframe.points;
  keyframe.images = std::move(images);
  KeyframeData data = data_of(map_, keyframe);
  for (PointId id = first_new; id < map_.points().next_id(); ++id) recent_points_.push_back(id);
  cull_recent_points(map_, keyframe.id, recent_points_);
  depths_.push_back({keyframe.id, cells});
  if (depths_.size() > kAwaitingBoxes) depths_.pop_front();
  job_centre_ = keyframe.id;
  if (!grows_) {
    temporary_.push_back(keyframe.id);
    remember({keyframe.id, keyframe.stamp_ns, keyframe.map_from_camera});
  }
  return data;
}

std::optional<KeyframeId> LocalMapper::cull_temporary() {
  if (temporary_.size() <= kTemporary) return std::nullopt;
  const KeyframeId oldest = temporary_.front();
  temporary_.pop_front();
  map_.cull_keyframe(oldest);
  settle_pose(oldest);
  return oldest;
}

/// Of a temporary keyframe that the map does not hold any more: what comes later tells nothing of it.
void LocalMapper::settle_pose(KeyframeId id) {
  const auto known = std::ranges::lower_bound(outside_, id, {}, &KeyframePose::id);
  if (known != outside_.end() && known->id == id) known->map_from_camera = map_.pose_of(id);
}

/// A keyframe made while the map does not grow.
void LocalMapper::remember(const KeyframePose& keyframe) {
  outside_.push_back(keyframe);
  if (outside_.size() > kOutside && !keep_all_poses_) outside_.pop_front();
}

KeyframePose LocalMapper::insert_pose_only(const TrackedFrame& frame, KeyframeId anchor) {
  const Pose map_from_camera = frame.camera_from_map.inverse();
  KeyframeRecords& records = map_.records();
  if (!grows_) {
    remember({records.next_id(), frame.stamp_ns, map_from_camera});
    records.skip_ids(records.next_id() + 1);
    return outside_.back();
  }
  if (job_centre_ == kNoId) job_centre_ = anchor;  // nothing new: what is there gets better
  const KeyframeId id =
      records.add_pose_only(frame.stamp_ns, anchor, map_.pose_of(anchor).inverse() * map_from_camera);
  if (!keep_all_poses_) records.forget_pose_only(anchor, frame.stamp_ns);
  return {id, frame.stamp_ns, map_from_camera};
}

KeyframeData LocalMapper::keyframe_data(KeyframeId id) const {
  const Keyframe* keyframe = map_.keyframe(id);
  if (keyframe == nullptr) throw std::out_of_range("LocalMapper::keyframe_data: no such keyframe");
  return data_of(map_, *keyframe);
}

std::vector<KeyframePose> LocalMapper::keyframe_poses() const {
  if (grows_) return tracker::keyframe_poses(map_, map_.records().first_free());
  std::vector<KeyframePose> poses(outside_.begin(), outside_.end());
  for (KeyframePose& k : poses)
    if (const Keyframe* keyframe = map_.keyframe(k.id)) k.map_from_camera = keyframe->map_from_camera;
  return poses;
}

const segmentation::PictureCells* LocalMapper::cells_of(KeyframeId keyframe) const {
  const auto depth = std::ranges::find(depths_, keyframe, &KeyframeDepth::keyframe);
  return depth == depths_.end() ? nullptr : &depth->cells;
}

void LocalMapper::retract(KeyframeId keyframe, const MovableMask& movable) {
  const PointId first_new = map_.points().next_id();
  retract_movable(map_, keyframe, movable, settings_.depth);
  for (PointId id = first_new; id < map_.points().next_id(); ++id) recent_points_.push_back(id);
}

std::optional<LocalMappingJob> LocalMapper::take_job(const SelfCalibration& calibration) {
  const KeyframeId centre = std::exchange(job_centre_, kNoId);
  if (map_.keyframe(centre) == nullptr) return std::nullopt;  // none is due, or it was culled
  return prepared(make_mapping_job(map_, centre), calibration);
}

/// With what is known of the camera.
LocalMappingJob LocalMapper::prepared(LocalMappingJob&& job, const SelfCalibration& calibration) const {
  job.revision = revision_;
  job.readout_s = calibration.readout_s();
  job.focal_scale = calibration.focal_scale();
  job.given_fx = calibration.given_fx();
  job.pyramid = settings_.pyramid;
  job.triangulates = settings_.depth.triangulate;
  return job;
}

std::optional<std::vector<KeyframeId>> LocalMapper::apply(const LocalMappingResult& result) {
  if (result.revision != revision_) {
    if (job_centre_ == kNoId) job_centre_ = result.keyframe;  // once more, as the map is now
    return std::nullopt;
  }
  const PointId first_new = map_.points().next_id();
  apply_mapping_result(map_, result);
  for (PointId id = first_new; id < map_.points().next_id(); ++id) recent_points_.push_back(id);
  auto culled = cull_redundant_keyframes(map_, result.keyframe, settings_.depth);
  if (!grows_) std::ranges::for_each(culled, [this](KeyframeId id) { settle_pose(id); });
  std::erase_if(temporary_, [this](KeyframeId id) { return std::as_const(map_).keyframe(id) == nullptr; });
  return culled;
}

bool LocalMapper::is_mostly_static(KeyframeId id) const {
  const Keyframe* keyframe = map_.keyframe(id);
  return keyframe != nullptr &&
         2 * std::ranges::count(keyframe->movable, true) <= std::ssize(keyframe->movable);
}

std::optional<ReplacedPoints> LocalMapper::correct(std::span<const KeyframePose> corrected,
                                                   std::span<const LoopMatch> loops) {
  if (!loops.empty() && !confirms(map_, loops)) return std::nullopt;
  apply_correction(map_, corrected);
  ++revision_;
  return join(loops);
}

ReplacedPoints LocalMapper::join(std::span<const LoopMatch> loops) {
  ReplacedPoints replaced;
  for (const LoopMatch& loop : loops) {
    auto by_loop = join_loop(map_, loop);
    if (!by_loop) continue;
    adjustment_is_due_ = true;
    replaced.merge(*by_loop);
  }
  return replaced;
}

std::optional<ReplacedPoints> LocalMapper::join(const SubmapMove& move,
                                                std::span<const FoundKeyframe> sightings) {
  if (!are_confirmed(map_, sightings) || !fits(map_, move)) return std::nullopt;
  move_submap(map_, move);
  ++revision_;
  std::vector<LoopMatch> loops;
  std::ranges::transform(sightings, std::back_inserter(loops), &FoundKeyframe::match);
  return join(loops);
}

std::optional<LocalMappingJob> LocalMapper::take_adjustment(const SelfCalibration& calibration) {
  if (!std::exchange(adjustment_is_due_, false)) return std::nullopt;
  return prepared(make_global_job(map_), calibration);
}

bool LocalMapper::apply_adjustment(const LocalMappingResult& result) {
  if (result.revision != revision_) return false;
  apply_global_adjustment(map_, result);
  ++revision_;
  return true;
}

void LocalMapper::start_from(SlamMap&& map, bool rows_are_known) {
  map_ = std::move(map);
  if (rows_are_known) checkpoint_.mark_written(map_);
}

}  // namespace rds::tracker
