// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/point_following.hpp"

#include <algorithm>

#include "services/tracker/core/feature_alignment.hpp"

namespace rds::tracker {
namespace {

constexpr float kBorder = 8;        // px of the picture that a patch needs around it
constexpr double kPatchRadius = 4;  // px, at the feature's level
constexpr float kCell = 32;         // px, side of the parts of the picture that points are spread over
constexpr std::size_t kPointsPerPart = 32;

/// A map point that the picture should show.
struct Expected {
  const MapPoint* point;
  Eigen::Vector2f image_px;
  int level;
  bool hidden;  // by something movable
};

/// True if what surrounds a point is movable, even in part: the patch would pull it along.
bool is_hidden(const FollowingView& view, const Eigen::Vector2f& px, double scale) {
  if (!view.movable.any()) return false;
  const auto radius = static_cast<float>(kPatchRadius * scale);
  return view.movable.covers(px) || view.movable.covers(px + Eigen::Vector2f(radius, radius)) ||
         view.movable.covers(px + Eigen::Vector2f(radius, -radius)) ||
         view.movable.covers(px + Eigen::Vector2f(-radius, radius)) ||
         view.movable.covers(px + Eigen::Vector2f(-radius, -radius));
}

std::vector<Expected> expect(const SlamMap& map, std::span<const PointId> points, const FollowingView& view,
                             const Eigen::Vector3d& camera_in_map, const ObservationModel& model,
                             const ScalePyramid& pyramid) {
  const geometry::CameraModel& camera = view.picture.camera;
  const FeatureSet bounds(camera, {});
  const Eigen::Vector2f largest(static_cast<float>(camera.width - 1) - kBorder,
                                static_cast<float>(camera.height - 1) - kBorder);
  std::vector<Expected> all;
  for (const PointId id : points) {
    const MapPoint* point = map.point(id);
    if (point == nullptr) continue;
    const auto projected = project_point(*point, view.camera_from_map, camera_in_map, bounds, model, pyramid);
    if (!projected) continue;
    const Eigen::Vector2f px =
        project_rolling(camera, view.motion, view.camera_from_map * point->position).cast<float>();
    if ((px.array() >= kBorder).all() && (px.array() <= largest.array()).all())
      all.push_back({point, px, projected->level,
                     is_hidden(view, px, pyramid.scale(projected->level)) && trust(map, *point) < 1});
  }
  return all;
}

/// Indices: the most observed point of each cell of the picture, then the second of each, and so on.
std::vector<std::size_t> spread(const std::vector<Expected>& expected, const geometry::CameraModel& camera) {
  const auto columns = static_cast<std::size_t>(static_cast<float>(camera.width) / kCell) + 1;
  const auto rows = static_cast<std::size_t>(static_cast<float>(camera.height) / kCell) + 1;
  std::vector<std::vector<std::size_t>> cells(columns * rows);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Eigen::Vector2f cell = expected[i].image_px / kCell;
    cells[static_cast<std::size_t>(cell.y()) * columns + static_cast<std::size_t>(cell.x())].push_back(i);
  }
  std::size_t fullest = 0;
  for (auto& cell : cells) {
    std::ranges::stable_sort(cell, std::ranges::greater{},
                             [&](std::size_t i) { return expected[i].point->observations.size(); });
    fullest = std::max(fullest, cell.size());
  }
  std::vector<std::size_t> order;
  order.reserve(expected.size());
  for (std::size_t rank = 0; rank < fullest; ++rank)
    for (const auto& cell : cells)
      if (rank < cell.size()) order.push_back(cell[rank]);
  return order;
}

/// The observation from the nearest place whose picture is kept; null if there is none.
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

std::optional<Feature> find(const SlamMap& map, const Expected& expected, const FollowingView& view,
                            const Eigen::Vector3d& camera_in_map, const ScalePyramid& pyramid,
                            const FollowingConfig& config) {
  const MapPoint& point = *expected.point;
  const Observation* seen = nearest_view(map, point, camera_in_map);
  if (seen == nullptr) return std::nullopt;
  const Keyframe& keyframe = *map.keyframe(seen->keyframe);
  const Feature& known = (*keyframe.features)[seen->feature];
  const auto aligned = align_feature(warp_of(keyframe, known, point, view, pyramid), view.images,
                                     expected.image_px, config.max_shift_px);
  if (!aligned || static_cast<double>(aligned->correlation) < config.min_correlation) return std::nullopt;
  Feature feature;
  feature.px = feature.image_px = aligned->image_px;
  feature.angle_rad = known.angle_rad;
  feature.level = static_cast<std::uint8_t>(expected.level);
  feature.descriptor = point.descriptor;
  feature.matchable = false;
  return feature;
}

Feature hidden_feature(const Eigen::Vector2f& image_px) {
  Feature feature;
  feature.px = feature.image_px = image_px;
  feature.movable = true;
  feature.matchable = false;
  return feature;
}

}  // namespace

FollowedPoints follow_points(const SlamMap& map, std::span<const PointId> points, const FollowingView& view,
                             const ObservationModel& model, const ScalePyramid& pyramid,
                             const FollowingConfig& config, const RunParts& run_parts) {
  const Eigen::Vector3d camera_in_map = view.camera_from_map.inverse().translation();
  const auto expected = expect(map, points, view, camera_in_map, model, pyramid);
  const auto order = spread(expected, view.picture.camera);
  std::vector<std::optional<Feature>> found(order.size());
  FollowedPoints followed;
  auto wanted = static_cast<std::size_t>(config.points);
  for (std::size_t begin = 0; begin < order.size() && wanted > 0;) {
    // No more than are wanted at least have to be looked for.
    const std::size_t end = std::min(order.size(), begin + wanted);
    run_parts((end - begin + kPointsPerPart - 1) / kPointsPerPart, [&](std::size_t part) {
      const std::size_t first = begin + part * kPointsPerPart;
      for (std::size_t i = first; i < std::min(end, first + kPointsPerPart); ++i)
        if (const Expected& e = expected[order[i]]; !e.hidden)
          found[i] = find(map, e, view, camera_in_map, pyramid, config);
    });
    for (; begin < end; ++begin) {
      const Expected& e = expected[order[begin]];
      if (e.hidden) {
        followed.features.push_back(hidden_feature(e.image_px));
        followed.points.push_back(kNoId);
        continue;
      }
      followed.looked_for.push_back(e.point->id);
      if (!found[begin]) continue;
      --wanted;
      followed.features.push_back(*found[begin]);
      followed.points.push_back(e.point->id);
    }
  }
  return followed;
}

}  // namespace rds::tracker
