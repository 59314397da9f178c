// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/loops/loop_appearance.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include "services/tracker/core/pose/point_following.hpp"

namespace rds::tracker {
namespace {

constexpr float kNearPx = 12;         // from a point to the measurements that it is compared with
constexpr double kSlackShare = 0.05;  // of the depth, between neighbours on a slanted surface
constexpr int kFewest = 40;           // points that say something
// The share of points that look as they did is .76 … .92 in the same place, seen from far less; in rooms of
// the same shape and furniture, with other pictures on the walls, .41 … .78. Logistic between the two.
constexpr double kEvenShare = 0.72;
constexpr double kSharePerNat = 0.04;
constexpr double kTwins = 0.05;  // of places that look alike, those that do so in every detail

/// Whether the keyframe measured a surface at the point.
bool is_measured(const Keyframe& keyframe, const Eigen::Vector3d& in_camera, int levels) {
  if (in_camera.z() <= 0) return false;
  const Eigen::Vector2d px = keyframe.features->camera().project_undistorted(in_camera);
  bool is_there = false;
  keyframe.features->for_each_near(px.cast<float>(), kNearPx, 0, levels, [&](std::uint32_t i) {
    const double measured = (*keyframe.features)[i].depth_m;
    if (measured <= 0 || keyframe.movable[i]) return;
    is_there = is_there || std::abs(measured - in_camera.z()) <= kSlackShare * measured;
  });
  return is_there;
}

/// Whether the picture of a keyframe that saw it is kept: not of those from a saved map.
bool has_picture(const SlamMap& map, const MapPoint& point) {
  return std::ranges::any_of(point.observations, [&](const Observation& o) {
    const Keyframe* keyframe = map.keyframe(o.keyframe);
    return keyframe != nullptr && keyframe->images != nullptr;
  });
}

}  // namespace

double SeenAgain::log_odds() const {
  if (expected < kFewest) return 0;
  return -std::log((1 - kTwins) * std::exp((kEvenShare - share()) / kSharePerNat) + kTwins);
}

SeenAgain see_again(const SlamMap& map, std::span<const PointId> points, const Keyframe& keyframe,
                    const Pose& camera_from_map) {
  if (!keyframe.images) return {};
  std::vector<PointId> measured;
  std::ranges::copy_if(points, std::back_inserter(measured), [&](PointId id) {
    const MapPoint& point = *map.point(id);
    return has_picture(map, point) &&
           is_measured(keyframe, camera_from_map * point.position, map.pyramid().levels());
  });
  image::RgbdFrame picture;
  picture.camera = keyframe.features->camera();
  const ObservationModel model(picture.camera);
  PointSearch search(map, measured, {picture, *keyframe.images, camera_from_map, keyframe.motion}, model,
                     map.pyramid(), std::numeric_limits<int>::max());
  const FollowedPoints followed = search.find({});
  return {static_cast<int>(followed.looked_for.size()), static_cast<int>(followed.points.size())};
}

}  // namespace rds::tracker
