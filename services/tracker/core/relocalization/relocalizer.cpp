// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/relocalization/relocalizer.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "services/tracker/core/relocalization/relief.hpp"

namespace rds::tracker {
namespace {

constexpr std::size_t kCandidates = 4;           // keyframes tried per frame
constexpr std::size_t kCandidatesElsewhere = 2;  // keyframes of other submaps tried per keyframe
constexpr int kRansacIterations = 200;
constexpr float kRansacErrorPx = 6;
constexpr double kRansacConfidence = 0.995;
constexpr int kMinRefined = 10;
constexpr double kWideWindow = 6;  // window factors of the two widening rounds
constexpr double kNarrowWindow = 3;
constexpr std::size_t kNeighbours = 8;

/// Pose from the frame's matches; matches that disagree are removed.
bool solve_pnp(const SlamMap& map, TrackedFrame& frame) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  std::vector<std::size_t> feature;
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    const MapPoint* point = map.point(frame.points[i]);
    if (point == nullptr) continue;
    points.emplace_back(point->position.x(), point->position.y(), point->position.z());
    pixels.emplace_back((*frame.features)[i].px.x(), (*frame.features)[i].px.y());
    feature.push_back(i);
  }
  if (static_cast<int>(points.size()) < kMinKeyframeMatches) return false;
  const geometry::CameraModel& c = frame.features->camera();
  const cv::Matx33d K(c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
  cv::Mat rotation_vector;
  cv::Mat translation;
  std::vector<int> inliers;
  if (!cv::solvePnPRansac(points, pixels, K, cv::noArray(), rotation_vector, translation, false,
                          kRansacIterations, kRansacErrorPx, kRansacConfidence, inliers, cv::SOLVEPNP_EPNP))
    return false;
  if (static_cast<int>(inliers.size()) < kMinRefined) return false;
  cv::Matx33d rotation;
  cv::Rodrigues(rotation_vector, rotation);
  Eigen::Matrix3d R;
  Eigen::Vector3d t;
  cv::cv2eigen(rotation, R);
  cv::cv2eigen(translation, t);
  frame.camera_from_map = geometry::make_pose(t, Eigen::Quaterniond(R));
  std::vector<PointId> kept(frame.points.size(), kNoId);
  for (const int i : inliers) {
    const std::size_t f = feature[static_cast<std::size_t>(i)];
    kept[f] = frame.points[f];
  }
  frame.points = std::move(kept);
  return geometry::is_finite(frame.camera_from_map);
}

double relief_seen_by(const SlamMap& map, const TrackedFrame& frame) {
  std::vector<Eigen::Vector3d> points;
  for (const PointId id : frame.points)
    if (const MapPoint* point = map.point(id)) points.push_back(point->position);
  return relief_of(points, frame.camera_from_map.inverse().translation());
}

/// Points of the keyframe and its best neighbours, each once.
std::vector<PointId> points_around(const SlamMap& map, const Keyframe& keyframe) {
  std::vector<PointId> points;
  const auto add = [&](const Keyframe& k) {
    std::ranges::copy_if(k.points, std::back_inserter(points), [](PointId p) { return p != kNoId; });
  };
  add(keyframe);
  for (std::size_t i = 0; i < std::min(kNeighbours, keyframe.covisible.size()); ++i)
    add(*map.keyframe(keyframe.covisible[i].id));
  std::ranges::sort(points);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

std::vector<PointId> not_seen(std::vector<PointId> points, const TrackedFrame& frame) {
  std::vector<PointId> seen(frame.points);
  std::ranges::sort(seen);
  std::erase_if(points, [&](PointId p) { return std::ranges::binary_search(seen, p); });
  return points;
}

/// Whether an angle between directions over the ground can be told.
constexpr double kLeastLevel = 0.3;  // of a unit vector

}  // namespace

bool SoughtPlace::contains(const Pose& map_from_other) const {
  const Eigen::Vector2d apart =
      map_from_other.translation().head<2>() - map_from_camera.translation().head<2>();
  if (!(apart.norm() <= radius_m)) return false;
  const Eigen::Vector2d ahead = map_from_camera.linear().col(2).head<2>();
  const Eigen::Vector2d other = map_from_other.linear().col(2).head<2>();
  if (ahead.norm() < kLeastLevel || other.norm() < kLeastLevel) return true;
  return ahead.normalized().dot(other.normalized()) >= std::cos(max_angle_rad);
}

bool Relocalizer::localize(const TrackingContext& context, const Where& where, TrackedFrame& frame) const {
  std::size_t tried = 0;
  for (const auto& candidate : places_.query(static_descriptors(*frame.features), places_.size())) {
    const Keyframe* keyframe = std::as_const(context.map).keyframe(candidate.id);
    if (keyframe == nullptr || !where(*keyframe)) continue;
    if (tried++ == kCandidates) break;
    if (localize_against(context, candidate.id, frame)) return true;
  }
  return false;
}

std::optional<FoundKeyframe> Relocalizer::find_in_others(SlamMap& map, const PoseSettings& settings,
                                                         KeyframeId id) const {
  const Keyframe* keyframe = std::as_const(map).keyframe(id);
  if (keyframe == nullptr) return std::nullopt;
  image::RgbdFrame no_picture;
  no_picture.camera = keyframe->features->camera();
  const TrackingContext context{map, settings, no_picture, ObservationModel(no_picture.camera), {}, {}};
  TrackedFrame frame;
  frame.features = keyframe->features;
  frame.time_ns = keyframe->time_ns;
  const Submaps& submaps = map.records().submaps();
  std::size_t tried = 0;
  for (const auto& place : places_.query(static_descriptors(*keyframe->features), places_.size())) {
    if (submaps.of(place.id) == submaps.of(id)) continue;
    if (tried++ == kCandidatesElsewhere) break;
    if (!localize_against(context, place.id, frame)) continue;
    const Pose found_from_map = std::as_const(map).keyframe(place.id)->map_from_camera.inverse();
    return FoundKeyframe{{id, place.id, found_from_map * frame.camera_from_map.inverse()},
                         frame.static_matches()};
  }
  return std::nullopt;
}

bool Relocalizer::localize_against(const TrackingContext& context, KeyframeId id, TrackedFrame& frame) {
  const Keyframe* keyframe = context.map.keyframe(id);
  if (keyframe == nullptr) return false;
  if (match_keyframe(context.map, *keyframe, frame) < kMinKeyframeMatches) return false;
  if (!solve_pnp(context.map, frame)) return false;
  if (optimize(context, frame) < kMinRefined) return false;
  localize_near(context, *keyframe, frame);
  return frame.static_matches() >= kMinInliers && relief_seen_by(context.map, frame) >= kMinRelief;
}

void Relocalizer::localize_near(const TrackingContext& context, const Keyframe& keyframe,
                                TrackedFrame& frame) {
  const auto points = points_around(context.map, keyframe);
  for (const double window : {kWideWindow, kNarrowWindow}) {
    match_points(context.map, not_seen(points, frame), context.model, context.settings.pyramid, window,
                 frame);
    optimize(context, frame);
  }
}

void Relocalizer::index_pending(const SlamMap& map) {
  if (const Keyframe* keyframe = map.keyframe(std::exchange(pending_, kNoId)))
    places_.add(keyframe->id, static_descriptors(*keyframe->features));
}

void Relocalizer::index_all(const SlamMap& map) {
  map.keyframes().for_each([this](const Keyframe& k) { places_.add(k.id, static_descriptors(*k.features)); });
}

cv::Mat static_descriptors(const FeatureSet& features) {
  cv::Mat descriptors(0, static_cast<int>(sizeof(Descriptor)), CV_8UC1);
  descriptors.reserve(features.size());
  for (const Feature& f : features.all())
    if (!f.movable)
      descriptors.push_back(cv::Mat(1, static_cast<int>(sizeof(Descriptor)), CV_8UC1,
                                    const_cast<std::uint8_t*>(f.descriptor.data())));
  return descriptors;
}

}  // namespace rds::tracker
