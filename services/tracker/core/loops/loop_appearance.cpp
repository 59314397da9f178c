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

constexpr float kNearPx = 12;             // from a point to the measurements that it is compared with
constexpr double kSlackShare = 0.05;      // of the depth, between neighbours on a slanted surface
constexpr int kFewest = 40;               // points that say something
constexpr double kAlikeFromThere = 0.88;  // p(0)
constexpr double kAngleRad = 0.87;  // by which p falls to 1/e: patches are taken as parallel to the picture
constexpr double kAlikeElsewhere = 0.73;  // of p
constexpr double kIndependent = 22;       // points, of all
constexpr double kTwins = 0.05;           // of places that look alike, those that do so in every detail

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

/// Between the directions from which a point is seen and was seen from nearest [rad].
double angle_of_views(const SlamMap& map, const MapPoint& point, const Eigen::Vector3d& camera_in_map) {
  const KeyframeId seen_by = nearest_view(map, point, camera_in_map)->keyframe;
  const Eigen::Vector3d there = map.keyframe(seen_by)->map_from_camera.translation() - point.position;
  const Eigen::Vector3d here = camera_in_map - point.position;
  return std::acos(std::clamp(there.normalized().dot(here.normalized()), -1.0, 1.0));
}

}  // namespace

double SeenAgain::log_odds() const {
  if (expected < kFewest) return 0;
  const double same = kIndependent * log_ratios / expected;
  return -std::log((1 - kTwins) * std::exp(-same) + kTwins);
}

void SeenAgain::add(double angle_rad, bool is_alike) {
  const double same = kAlikeFromThere * std::exp(-angle_rad / kAngleRad);
  const double other = kAlikeElsewhere * same;
  ++expected;
  log_ratios += is_alike ? std::log(same / other) : std::log((1 - same) / (1 - other));
}

void SeenAgain::operator+=(const SeenAgain& other) {
  expected += other.expected;
  log_ratios += other.log_ratios;
}

SeenAgain see_again(const SlamMap& map, std::span<const PointId> points, const Keyframe& keyframe,
                    const Pose& camera_from_map) {
  if (!keyframe.images) return {};
  const Eigen::Vector3d camera_in_map = camera_from_map.inverse().translation();
  std::vector<PointId> measured;
  std::ranges::copy_if(points, std::back_inserter(measured), [&](PointId id) {
    const MapPoint& point = *map.point(id);
    return nearest_view(map, point, camera_in_map) != nullptr &&
           is_measured(keyframe, camera_from_map * point.position, map.pyramid().levels());
  });
  image::RgbdFrame picture;
  picture.camera = keyframe.features->camera();
  const ObservationModel model(picture.camera);
  PointSearch search(map, measured, {picture, *keyframe.images, camera_from_map, keyframe.motion}, model,
                     map.pyramid(), std::numeric_limits<int>::max());
  const FollowedPoints followed = search.find({});
  SeenAgain again;
  auto found = followed.points.begin();
  for (const PointId id : followed.looked_for) {
    const bool is_alike = found != followed.points.end() && *found == id;
    if (is_alike) ++found;
    again.add(angle_of_views(map, *map.point(id), camera_in_map), is_alike);
  }
  return again;
}

}  // namespace rds::tracker
