// SPDX-License-Identifier: Apache-2.0
// The part of Tracker that follows map points from picture to picture, without extracting features.
#include <algorithm>
#include <bitset>

#include "services/tracker/core/pose/sparse_image_alignment.hpp"
#include "services/tracker/core/tracker.hpp"

namespace rds::tracker {
namespace {

constexpr double kMinDepth = 0.05;          // m
constexpr std::size_t kEnoughToAlign = 40;  // points of the last frame
constexpr double kTakeOverWindowPx = 2;     // between a followed point and the corner that is taken for it
constexpr int kSurePoints = 3;              // times min_points, that what moves can hardly be
constexpr int kCells = 20;                  // of the picture's width and height, for its covered part

/// Cells of the picture in which the frame sees map points.
int covered_cells(const TrackedFrame& frame) {
  const geometry::CameraModel& camera = frame.features->camera();
  std::bitset<kCells * kCells> covered;
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    if (frame.points[i] == kNoId) continue;
    const Eigen::Vector2f& px = (*frame.features)[i].image_px;
    const auto column = static_cast<std::size_t>(px.x() / static_cast<float>(camera.width) * kCells);
    const auto row = static_cast<std::size_t>(px.y() / static_cast<float>(camera.height) * kCells);
    if (column < kCells && row < kCells) covered.set(row * kCells + column);
  }
  return static_cast<int>(covered.count());
}

}  // namespace

/// Pose from how the last frame's points look now.
Pose Tracker::align_with_last(const image::RgbdFrame& picture) const {
  const Pose last_map_from_camera = this->last_map_from_camera();
  const Pose last_camera_from_map = last_map_from_camera.inverse();
  std::vector<SeenPoint> seen;
  for (std::size_t i = 0; i < last_->frame.points.size(); ++i) {
    const MapPoint* point = map_.point(last_->frame.points[i]);
    if (point == nullptr || (last_->frame.movable_there && point->observations.size() < 2)) continue;
    const Feature& f = (*last_->frame.features)[i];
    const Eigen::Vector3d p = last_camera_from_map * point->position;
    if (p.z() > kMinDepth) seen.push_back({f.image_px, p});
  }
  Pose expected = expected_at(time_ns_);
  if (seen.size() < kEnoughToAlign) return expected;
  return align_sparsely(*last_->images, seen, *images_, picture.camera, expected * last_map_from_camera,
                        config_.following) *
         last_camera_from_map;
}

bool Tracker::can_follow(const Surroundings& around) const {
  const bool located = state_ == State::kTracking || state_ == State::kRelocalised;
  return follows_points() && located && around.camera_from_map && around.reference != kNoId &&
         map_.keyframe(around.reference)->images;
}

/// For the points around, near where the guess has them.
PointSearch Tracker::search_around(const image::RgbdFrame& picture, const Surroundings& around,
                                   const Pose& guess) const {
  const ObservationModel model(picture.camera, config_.depth);
  return {map_,  around.points, {picture, *images_, guess, shutter_motion(time_ns_)},
          model, pyramid_,      config_.following};
}

/// The points that are found, and the pose they agree on.
/// @return nullopt where too few do.
std::optional<Tracker::FollowedFrame> Tracker::follow_points(const image::RgbdFrame& picture,
                                                             PointSearch& search, const Pose& guess,
                                                             const MovableMask& movable,
                                                             const TrackedFrame& begun) const {
  const FollowingConfig& config = config_.following;
  FollowedFrame result{begun, {}, nullptr};
  TrackedFrame& frame = result.frame;
  frame.camera_from_map = guess;
  frame.motion = shutter_motion(frame.time_ns);
  FollowedPoints followed = search.find(movable, run_parts_);
  set_features(picture, std::move(followed.features), frame);
  frame.points = std::move(followed.points);
  result.looked_for = std::move(followed.looked_for);
  const int found = frame.matches();
  const ObservationModel model(picture.camera, config_.depth);
  const int inliers = optimize_frame(map_, model, pyramid_, config_.pose, frame);
  if (inliers < config.min_points || inliers < config.min_inlier_share * found) return std::nullopt;
  return result;
}

/// From where the frame is expected and, if that is not what the last frame's points say, from there.
std::optional<Tracker::FollowedFrame> Tracker::follow_map(const image::RgbdFrame& picture,
                                                          Surroundings& around, const MovableMask& movable,
                                                          const TrackedFrame& begun) const {
  if (!around.search) return std::nullopt;
  auto best = follow_points(picture, *around.search, *around.camera_from_map, movable, begun);
  if (!around.aligned || (best && jerk(best->frame) <= 1)) return best;
  PointSearch search = search_around(picture, around, *around.aligned);
  auto other = follow_points(picture, search, *around.aligned, movable, begun);
  return other && (!best || support(other->frame) > support(best->frame)) ? std::move(other)
                                                                          : std::move(best);
}

/// Makes a followed frame's pose that of the tracker, unless it shows too little of what it should.
bool Tracker::accept(FollowedFrame& followed, KeyframeId reference) {
  TrackedFrame& frame = followed.frame;
  for (const PointId id : followed.looked_for) ++map_.point(id)->visible;
  count_found(frame);
  note_found(static_cast<int>(followed.looked_for.size()), frame.matches(), found_by_following_, frame);
  // Movable objects hide what is expected; then few found points say nothing against the pose.
  const bool sees_enough = frame.movable_there || frame.found_share >= config_.quality.min_found_share;
  if (!sees_enough || has_jumped(frame)) return false;
  reference_ = reference;
  state_ = State::kTracking;
  return true;
}

/// By following where that does, else by features.
KeyframeNeed Tracker::find_pose(const image::RgbdFrame& picture, Surroundings& around,
                                const MovableMask& movable, TrackedFrame& frame, FrameResult& result) {
  auto followed = follow_map(picture, around, movable, frame);
  if (!followed || !accept(*followed, around.reference))
    return track_features(picture, movable, frame, result);
  const bool sure = support(followed->frame) >= kSurePoints * config_.following.min_points;
  if (frame.movable_there && !sure) {
    const KeyframeNeed need = track_features(picture, movable, frame, result);
    if (has_pose(state_) && support(frame) > support(followed->frame)) return need;
    reference_ = around.reference;
    state_ = State::kTracking;
    followed->extracted = frame.features;
  }
  const auto extracted = std::move(followed->extracted);
  frame = std::move(followed->frame);
  return follow_with_keyframe(picture, movable, extracted, frame, result);
}

/// If the map needs the frame, matches features, extracted here unless they are there, where the pose is
/// known.
/// @return what the frame is to become.
KeyframeNeed Tracker::follow_with_keyframe(const image::RgbdFrame& picture, const MovableMask& movable,
                                           std::shared_ptr<const FeatureSet> features, TrackedFrame& frame,
                                           FrameResult& result) {
  if (!last_keyframe_ns_) return KeyframeNeed::kNone;
  const KnownView view = nearest_view(frame);
  const int covered = covered_cells(frame);
  if (view.keyframe != followed_view_) covered_at_view_ = covered;
  followed_view_ = view.keyframe;
  KeyframeFacts facts = keyframe_facts(frame, view.change);
  facts.seen = covered;
  facts.seen_by_reference = covered_at_view_;
  const KeyframeNeed need = tracker::keyframe_need(facts, config_.keyframe);
  if (need != KeyframeNeed::kMap) return need;
  TrackedFrame extracted = frame;
  extracted.features = std::move(features);
  if (extracted.features)
    extracted.clear_matches();
  else
    extract(picture, movable, extracted, result);
  take_over(frame, picture, extracted);
  TrackedFrame held = extracted;
  refine_with_local_map(extracted, 1);
  if (frame.movable_there && jerk(extracted) > std::max(1.0, jerk(frame))) {  // what moves took it along
    held.pose_is_given = true;
    refine_with_local_map(held, 1);
    extracted = std::move(held);
    extracted.pose_is_given = false;
  }
  if (extracted.static_matches() < config_.quality.min_inliers) return KeyframeNeed::kNone;
  frame = std::move(extracted);
  return KeyframeNeed::kMap;
}

/// A corner near a followed point is taken for it, and for standing where the point was found.
void Tracker::take_over(const TrackedFrame& followed, const image::RgbdFrame& picture,
                        TrackedFrame& frame) const {
  const ObservationModel model(picture.camera, config_.depth);
  std::vector<Feature> features = frame.features->all();
  for (std::size_t i = 0; i < followed.points.size(); ++i) {
    if (followed.points[i] == kNoId) continue;
    const Feature& f = (*followed.features)[i];
    const SearchWindow window{f.px, static_cast<float>(kTakeOverWindowPx * pyramid_.scale(f.level)),
                              f.level - 1, f.level + 1, 0};
    const auto corner = best_in_window(*frame.features, frame.points, model, f.descriptor, window,
                                       config_.matching.max_distance_frame, 1);
    if (!corner) continue;
    frame.points[*corner] = followed.points[i];
    features[*corner].px = f.px;
    features[*corner].image_px = f.image_px;
    features[*corner].depth_m = f.depth_m;
  }
  frame.features = std::make_shared<const FeatureSet>(picture.camera, std::move(features));
}

}  // namespace rds::tracker
