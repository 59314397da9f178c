// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/point_follower.hpp"

#include <utility>

#include "services/tracker/core/features/feature_set.hpp"
#include "services/tracker/core/pose/sparse_image_alignment.hpp"

namespace rds::tracker {
namespace {

constexpr std::size_t kEnoughToAlign = 40;  // points of the last frame
constexpr int kMinFollowed = 50;            // points that must agree on a pose; else features are matched
constexpr double kMinInlierShare = 0.5;     // of the points found, that must agree
constexpr int kSurePoints = 3;              // times kMinFollowed: support that no moving thing has

}  // namespace

Pose PointFollower::align(const TrackingContext& context, const LastFrame& last) const {
  const Pose& last_map_from_camera = context.motion.last_map_from_camera();
  const Pose last_camera_from_map = last_map_from_camera.inverse();
  std::vector<SeenPoint> seen;
  for (std::size_t i = 0; i < last.frame.points.size(); ++i) {
    const MapPoint* point = std::as_const(context.map).point(last.frame.points[i]);
    if (point == nullptr || (last.frame.movable_in_view && point->observations.size() < 2)) continue;
    const Feature& f = (*last.frame.features)[i];
    const Eigen::Vector3d p = last_camera_from_map * point->position;
    if (p.z() > kMinDepth) seen.push_back({f.image_px, p});
  }
  const Pose& predicted = context.motion.camera_from_map();
  if (seen.size() < kEnoughToAlign) return predicted;
  return align_sparsely(*last.frame.images, seen, *context.frame.images, context.picture.camera,
                        predicted * last_map_from_camera) *
         last_camera_from_map;
}

PointSearch PointFollower::search(const TrackingContext& context, const Pose& camera_from_map) const {
  return {context.map,
          context.local.points,
          {context.picture, *context.frame.images, camera_from_map, context.frame.motion},
          context.model,
          context.settings.pyramid,
          points_};
}

std::optional<FollowedFrame> PointFollower::follow(const TrackingContext& context, PointSearch& search,
                                                   const Pose& guess) const {
  FollowedFrame result{context.frame, {}};
  TrackedFrame& frame = result.frame;
  frame.camera_from_map = guess;
  FollowedPoints followed = search.find(context.movable, executor_);
  frame.features = complete_feature_set(context, std::move(followed.features));
  frame.points = std::move(followed.points);
  result.expected = std::move(followed.looked_for);
  const int found = frame.matches();
  const int inliers = optimize(context, frame);
  if (inliers < kMinFollowed || inliers < kMinInlierShare * found) return std::nullopt;
  return result;
}

std::optional<FollowedFrame> PointFollower::follow(const TrackingContext& context, const Pose& guess) const {
  PointSearch around = search(context, guess);
  return follow(context, around, guess);
}

std::optional<FollowedFrame> PointFollower::estimate(TrackingContext& context) const {
  if (!context.search) return std::nullopt;
  auto best = follow(context, *context.search, *context.guess);
  if (!context.alignment || (best && context.motion.innovation(best->frame.camera_from_map) <= 1))
    return best;
  auto other = follow(context, *context.alignment);
  const bool other_is_better =
      other && (!best || support(other->frame, context.motion) > support(best->frame, context.motion));
  return other_is_better ? std::move(other) : std::move(best);
}

void PointFollower::count_found(SlamMap& map, const std::vector<PointId>& expected, TrackedFrame& frame) {
  for (const PointId id : expected) ++map.point(id)->visible;
  count_found_points(map, frame);
  frame.found_share = found_share_.update(static_cast<int>(expected.size()), frame.matches());
}

bool PointFollower::is_sure(double support) const {
  return support >= kSurePoints * kMinFollowed;
}

}  // namespace rds::tracker
