// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/mapping_scene.hpp"

#include <algorithm>

#include "services/tracker/core/mapping/new_points.hpp"
#include "services/tracker/core/pose/association.hpp"

namespace rds::tracker {
namespace {

constexpr double kFusionWindowPx = 3;  // around the projection, at level 0

}  // namespace

MappingScene::MappingScene(const LocalMappingJob& job) : job_(job) {
  for (const MapPoint& p : job.points) {
    ScenePoint point;
    point.id = p.id;
    point.position = p.position;
    for (const Observation& o : p.observations)
      if (const auto k = keyframe_index(o.keyframe)) point.observations.push_back({*k, o.feature});
    points_.push_back(std::move(point));
  }
  for (const MappingKeyframe& k : job.keyframes) features_.push_back(k.points);
}

std::optional<std::size_t> MappingScene::index_of(PointId id) const {
  const auto place = std::ranges::lower_bound(job_.points, id, {}, &MapPoint::id);
  if (place == job_.points.end() || place->id != id) return std::nullopt;
  return static_cast<std::size_t>(place - job_.points.begin());
}

std::optional<std::size_t> MappingScene::keyframe_index(KeyframeId id) const {
  const auto place = std::ranges::lower_bound(job_.keyframes, id, {}, &MappingKeyframe::id);
  if (place == job_.keyframes.end() || place->id != id) return std::nullopt;
  return static_cast<std::size_t>(place - job_.keyframes.begin());
}

bool MappingScene::sees(std::size_t keyframe, std::size_t point) const {
  return std::ranges::any_of(points_[point].observations,
                             [&](const SceneObservation& o) { return o.keyframe == keyframe; });
}

void MappingScene::connect(std::size_t point, std::size_t keyframe, std::uint32_t feature,
                           LocalMappingResult& result) {
  if (job_.keyframes[keyframe].movable[feature]) return;
  PointId& seen = features_[keyframe][feature];
  if (seen == kNoId) {
    seen = points_[point].id;
    points_[point].observations.push_back({keyframe, feature});
    result.added.push_back({points_[point].id, job_.keyframes[keyframe].id, feature});
    return;
  }
  const auto other = index_of(seen);
  if (other && *other != point && points_[*other].alive) fuse(point, *other, result);
}

void MappingScene::fuse(std::size_t a, std::size_t b, LocalMappingResult& result) {
  ScenePoint& keep =
      points_[a].observations.size() >= points_[b].observations.size() ? points_[a] : points_[b];
  ScenePoint& drop = &keep == &points_[a] ? points_[b] : points_[a];
  const auto keep_index = static_cast<std::size_t>(&keep - points_.data());
  drop.alive = false;
  for (const SceneObservation& o : drop.observations) {
    const bool twice = sees(o.keyframe, keep_index);
    features_[o.keyframe][o.feature] = twice ? kNoId : keep.id;
    if (!twice) keep.observations.push_back(o);
  }
  drop.observations.clear();
  result.fused.push_back({keep.id, drop.id});
}

namespace {

void search_point(MappingScene& scene, std::size_t point, std::size_t keyframe, LocalMappingResult& result) {
  const LocalMappingJob& job = scene.job();
  const MappingKeyframe& view = job.keyframes[keyframe];
  const ObservationModel model(view.features->camera());
  const MapPoint& p = job.points[point];
  const auto projected = project_point(p, view.map_from_camera.inverse(), view.map_from_camera.translation(),
                                       *view.features, model, job.pyramid);
  if (!projected) return;
  const auto radius = static_cast<float>(kFusionWindowPx * job.pyramid.scale(projected->level));
  const SearchWindow window{projected->px.cast<float>(), radius, projected->level - 1, projected->level + 1,
                            model.disparity(projected->depth)};
  const auto found = best_in_window(*view.features, {}, model, p.descriptor, window, kMaxDistanceAlone, 1);
  if (found) scene.connect(point, keyframe, *found, result);
}

}  // namespace

void search_and_fuse(MappingScene& scene, LocalMappingResult& result) {
  const auto centre = scene.keyframe_index(scene.job().keyframe);
  if (!centre) return;
  for (std::size_t p = 0; p < scene.points().size(); ++p) {
    if (!scene.points()[p].alive) continue;
    if (!scene.sees(*centre, p)) {
      search_point(scene, p, *centre, result);
      continue;
    }
    for (std::size_t k = 0; k < scene.job().keyframes.size() && scene.points()[p].alive; ++k)
      if (k != *centre && !scene.sees(k, p)) search_point(scene, p, k, result);
  }
}

bool is_calibrated(const MappingKeyframe& keyframe, const LocalMappingJob& job) {
  return keyframe.given_fx > 0 && keyframe.given_fx == job.given_fx;
}

geometry::CameraModel known_camera(const MappingKeyframe& keyframe, const LocalMappingJob& job) {
  geometry::CameraModel camera = keyframe.features->camera();
  if (!is_calibrated(keyframe, job)) return camera;
  const double correction = job.focal_scale * job.given_fx / camera.fx;
  camera.fx *= correction;
  camera.fy *= correction;
  return camera;
}

LocalMappingResult run_local_mapping(const LocalMappingJob& job, int iterations) {
  LocalMappingResult result;
  result.keyframe = job.keyframe;
  result.next_keyframe = job.next_keyframe;
  result.next_point = job.next_point;
  result.revision = job.revision;
  MappingScene scene(job);
  search_and_fuse(scene, result);
  result.imaging = adjust_bundle(scene, {.iterations = iterations, .is_sparse = false, .stop = {}}, result);
  if (job.triangulates) triangulate_points(scene, result);
  return result;
}

}  // namespace rds::tracker
