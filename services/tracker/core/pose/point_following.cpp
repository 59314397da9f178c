// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/point_following.hpp"

#include <algorithm>
#include <utility>

#include "services/tracker/core/pose/feature_alignment.hpp"

namespace rds::tracker {
namespace {

constexpr float kBorder = 8;        // px of the picture that a patch needs around it
constexpr double kPatchRadius = 4;  // px, at the feature's level
constexpr float kCell = 32;         // px, side of the parts of the picture that points are spread over
constexpr std::size_t kPointsPerPart = 32;
constexpr double kMinCorrelation = 0.8;  // of a point's patches
constexpr double kMaxShiftPx = 3;        // between expected and found place, in pixels of the patch

std::size_t parts_of(std::size_t points) {
  return (points + kPointsPerPart - 1) / kPointsPerPart;
}

/// True if what surrounds a point is movable, even in part: the patch would pull it along.
bool is_hidden(const MovableMask& movable, const Eigen::Vector2f& px, double scale) {
  const auto radius = static_cast<float>(kPatchRadius * scale);
  return movable.covers(px) || movable.covers(px + Eigen::Vector2f(radius, radius)) ||
         movable.covers(px + Eigen::Vector2f(radius, -radius)) ||
         movable.covers(px + Eigen::Vector2f(-radius, radius)) ||
         movable.covers(px + Eigen::Vector2f(-radius, -radius));
}

/// How the surroundings of a keyframe's feature show in the view, if they lie parallel to the keyframe's
/// picture. Distortion is taken as the same at both places.
PatchWarp warp_of(const Keyframe& keyframe, const Feature& feature, const MapPoint& point,
                  const FollowingView& view, const ScalePyramid& pyramid) {
  const geometry::CameraModel& camera = keyframe.features->camera();
  const double depth = (keyframe.map_from_camera.inverse() * point.position).z();
  Eigen::Matrix<double, 3, 2> point_by_px = Eigen::Matrix<double, 3, 2>::Zero();
  point_by_px(0, 0) = depth / camera.fx;
  point_by_px(1, 1) = depth / camera.fy;
  const Eigen::Matrix3d view_from_keyframe =
      view.camera_from_map.linear() * keyframe.map_from_camera.linear();
  const Eigen::Vector3d in_view = view.camera_from_map * point.position;
  PatchWarp warp;
  warp.reference = keyframe.images.get();
  warp.reference_px = feature.image_px;
  warp.picture_from_reference =
      (view.picture.camera.undistorted_by_point(in_view) * view_from_keyframe * point_by_px).cast<float>();
  warp.scale = pyramid.scale(feature.level);
  return warp;
}

Feature hidden_feature(const Eigen::Vector2f& image_px) {
  Feature feature;
  feature.px = feature.image_px = image_px;
  feature.movable = true;
  feature.matchable = false;
  return feature;
}

}  // namespace

const Observation* nearest_view(const SlamMap& map, const MapPoint& point,
                                const Eigen::Vector3d& camera_in_map) {
  const Observation* nearest = nullptr;
  double least = 0;
  for (const Observation& o : point.observations) {
    const Keyframe* keyframe = map.keyframe(o.keyframe);
    if (keyframe == nullptr || !keyframe->images) continue;
    const double distance = (keyframe->map_from_camera.translation() - camera_in_map).squaredNorm();
    if (nearest != nullptr && distance >= least) continue;
    nearest = &o;
    least = distance;
  }
  return nearest;
}

PointSearch::PointSearch(const SlamMap& map, std::span<const PointId> points, const FollowingView& view,
                         const ObservationModel& model, const ScalePyramid& pyramid, int wanted)
    : map_(map),
      view_(view),
      pyramid_(pyramid),
      wanted_(static_cast<std::size_t>(wanted)),
      camera_in_map_(view.camera_from_map.inverse().translation()) {
  expect(points, model);
  spread();
}

void PointSearch::expect(std::span<const PointId> points, const ObservationModel& model) {
  const geometry::CameraModel& camera = view_.picture.camera;
  const FeatureSet bounds(camera, {});
  const Eigen::Vector2f largest(static_cast<float>(camera.width - 1) - kBorder,
                                static_cast<float>(camera.height - 1) - kBorder);
  expected_.reserve(points.size());
  for (const PointId id : points) {
    const MapPoint* point = map_.point(id);
    if (point == nullptr) continue;
    const auto projected =
        project_point(*point, view_.camera_from_map, camera_in_map_, bounds, model, pyramid_);
    if (!projected) continue;
    const Eigen::Vector2f px =
        project_rolling(camera, view_.motion, view_.camera_from_map * point->position).cast<float>();
    if ((px.array() >= kBorder).all() && (px.array() <= largest.array()).all())
      expected_.push_back({.point = point, .image_px = px, .level = projected->level, .found = {}});
  }
}

/// Puts first the most observed point of each cell of the picture, then the second of each, and so on.
void PointSearch::spread() {
  const geometry::CameraModel& camera = view_.picture.camera;
  const auto columns = static_cast<std::size_t>(static_cast<float>(camera.width) / kCell) + 1;
  const auto rows = static_cast<std::size_t>(static_cast<float>(camera.height) / kCell) + 1;
  std::vector<std::vector<std::size_t>> cells(columns * rows);
  for (std::size_t i = 0; i < expected_.size(); ++i) {
    const Eigen::Vector2f cell = expected_[i].image_px / kCell;
    cells[static_cast<std::size_t>(cell.y()) * columns + static_cast<std::size_t>(cell.x())].push_back(i);
  }
  std::size_t fullest = 0;
  for (auto& cell : cells) {
    std::ranges::stable_sort(cell, std::ranges::greater{},
                             [this](std::size_t i) { return expected_[i].point->observations.size(); });
    fullest = std::max(fullest, cell.size());
  }
  std::vector<Expected> in_order;
  in_order.reserve(expected_.size());
  for (std::size_t rank = 0; rank < fullest; ++rank)
    for (const auto& cell : cells)
      if (rank < cell.size()) in_order.push_back(expected_[cell[rank]]);
  expected_ = std::move(in_order);
}

void PointSearch::hide(const MovableMask& movable) {
  if (!movable.any()) return;
  for (Expected& e : expected_)
    e.hidden = is_hidden(movable, e.image_px, pyramid_.scale(e.level)) && static_weight(map_, *e.point) < 1;
}

/// No more than are wanted at least have to be looked for.
std::size_t PointSearch::batch_end(std::size_t begin, std::size_t wanted) const {
  return std::min(expected_.size(), begin + wanted);
}

std::optional<Feature> PointSearch::align(const Expected& expected) const {
  const MapPoint& point = *expected.point;
  const Observation* seen = nearest_view(map_, point, camera_in_map_);
  if (seen == nullptr) return std::nullopt;
  const Keyframe& keyframe = *map_.keyframe(seen->keyframe);
  const Feature& known = (*keyframe.features)[seen->feature];
  const auto aligned = align_feature(warp_of(keyframe, known, point, view_, pyramid_), view_.images,
                                     expected.image_px, kMaxShiftPx);
  if (!aligned || static_cast<double>(aligned->correlation) < kMinCorrelation) return std::nullopt;
  Feature feature;
  feature.px = feature.image_px = aligned->image_px;
  feature.angle_rad = known.angle_rad;
  feature.level = static_cast<std::uint8_t>(expected.level);
  feature.descriptor = point.descriptor;
  feature.matchable = false;
  return feature;
}

void PointSearch::align_once(Expected& expected) const {
  if (!expected.hidden && !expected.looked_for) expected.found = align(expected);
  expected.looked_for = true;
}

void PointSearch::prefetch(const std::atomic<bool>& enough) {
  const std::size_t likely = batch_end(batch_end(0, wanted_), wanted_);  // also in place of those not found
  for (std::size_t i = 0; i < likely && !enough; ++i) align_once(expected_[i]);
}

FollowedPoints PointSearch::find(const MovableMask& movable, const Executor& executor) {
  hide(movable);
  FollowedPoints followed;
  std::size_t wanted = wanted_;
  for (std::size_t i = 0; i < expected_.size() && wanted > 0;) {
    const std::size_t end = batch_end(i, wanted);
    executor(parts_of(end - i), [&](std::size_t part) {
      const std::size_t first = i + part * kPointsPerPart;
      for (std::size_t k = first; k < std::min(end, first + kPointsPerPart); ++k) align_once(expected_[k]);
    });
    for (; i < end; ++i) {
      const Expected& e = expected_[i];
      if (e.hidden) {
        followed.features.push_back(hidden_feature(e.image_px));
        followed.points.push_back(kNoId);
        continue;
      }
      followed.looked_for.push_back(e.point->id);
      if (!e.found) continue;
      --wanted;
      followed.features.push_back(*e.found);
      followed.points.push_back(e.point->id);
    }
  }
  return followed;
}

}  // namespace rds::tracker
