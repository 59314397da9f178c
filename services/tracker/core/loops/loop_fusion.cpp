// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/loops/loop_fusion.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "services/tracker/core/loops/loop_appearance.hpp"
#include "services/tracker/core/loops/loop_drift.hpp"
#include "services/tracker/core/map/covisibility.hpp"
#include "services/tracker/core/pose/association.hpp"
#include "services/tracker/core/pose/pose_optimization.hpp"

namespace rds::tracker {
namespace {

constexpr std::size_t kNeighbours = 9;  // of the keyframe at either side that join with it
// A verified loop places a keyframe to about 5 mm and 3 mrad: 3 px for points 2 m away. Three times that.
constexpr double kMeasuredWindowPx = 9;
constexpr double kAlignedWindowPx = 3;  // once the points have aligned the sides, as in local mapping
constexpr int kMinAligned = 20;         // points that agree on how the sides stand to each other

/// A keyframe of the map, those that share most points with it, and all their points by id.
struct Side {
  KeyframeId centre = kNoId;
  std::vector<KeyframeId> keyframes;
  std::vector<PointId> points;
};

Side side_of(const SlamMap& map, KeyframeId id) {
  Side side{map.records().anchor_of(id).first, {}, {}};
  side.keyframes.push_back(side.centre);
  for (const CovisibleKeyframe& c : map.keyframe(side.centre)->covisible)
    if (side.keyframes.size() <= kNeighbours) side.keyframes.push_back(c.id);
  for (const KeyframeId k : side.keyframes)
    std::ranges::copy_if(map.keyframe(k)->points, std::back_inserter(side.points),
                         [](PointId p) { return p != kNoId; });
  std::ranges::sort(side.points);
  const auto twice = std::ranges::unique(side.points);
  side.points.erase(twice.begin(), twice.end());
  return side;
}

/// The features of a keyframe, at a pose that it is thought to have.
struct View {
  const Keyframe& keyframe;
  Pose camera_from_map;
  ObservationModel model;
};

/// The feature that shows the point.
std::optional<std::uint32_t> find_in(const View& view, const MapPoint& point, const ScalePyramid& pyramid,
                                     double window_px) {
  const FeatureSet& features = *view.keyframe.features;
  const auto projected =
      project_point(point, view.camera_from_map, view.camera_from_map.inverse().translation(), features,
                    view.model, pyramid);
  if (!projected) return std::nullopt;
  const SearchWindow window{
      projected->px.cast<float>(), static_cast<float>(window_px * pyramid.scale(projected->level)),
      projected->level - 1, projected->level + 1, view.model.disparity(projected->depth)};
  const auto found = best_in_window(features, {}, view.model, point.descriptor, window, kMaxDistanceAlone, 1);
  return found && !view.keyframe.movable[*found] ? found : std::nullopt;
}

bool share_points(const Side& a, const Side& b) {
  return std::ranges::find(a.keyframes, b.centre) != a.keyframes.end() ||
         std::ranges::find(b.keyframes, a.centre) != b.keyframes.end();
}

bool is_known(const SlamMap& map, const LoopMatch& loop) {
  return map.records().contains(loop.later) && map.records().contains(loop.earlier);
}

/// The pose of the keyframe at the later side's centre by the earlier side's points that show in it.
/// @return camera_from_map; nullopt if too few of them do.
std::optional<Pose> align(const SlamMap& map, const LoopMatch& loop, const Side& earlier, const Side& later) {
  const Keyframe& centre = *map.keyframe(later.centre);
  const Pose measured = map.pose_of(loop.earlier) * loop.earlier_from_later *
                        map.pose_of(loop.later).inverse() * centre.map_from_camera;
  const View view{centre, measured.inverse(), ObservationModel(centre.features->camera())};
  std::vector<PointObservation> observations;
  std::vector<bool> taken(centre.points.size());
  for (const PointId id : earlier.points) {
    const MapPoint& point = *map.point(id);
    const auto feature = find_in(view, point, map.pyramid(), kMeasuredWindowPx);
    if (!feature || taken[*feature]) continue;
    taken[*feature] = true;
    observations.push_back(
        {point.position, view.model.measurement((*centre.features)[*feature], map.pyramid()), 1});
  }
  const OptimizedPose optimized = optimize_pose(view.model, observations, view.camera_from_map);
  return optimized.inliers < kMinAligned ? std::nullopt : std::optional(optimized.camera_from_map);
}

/// Fuses points of one side into the keyframes of the other.
class Fusion {
 public:
  explicit Fusion(SlamMap& map) : map_(map) {}

  /// @param here_from_there  moves points of `from` to where the keyframes of `into` should see them.
  void fuse(const Side& from, const Side& into, const Pose& here_from_there) {
    for (const KeyframeId id : into.keyframes) {
      const Keyframe& keyframe = *std::as_const(map_).keyframe(id);
      const View view{keyframe, keyframe.map_from_camera.inverse(),
                      ObservationModel(keyframe.features->camera())};
      for (const PointId p : from.points) fuse(p, view, here_from_there);
    }
  }
  ReplacedPoints take_replaced() { return std::move(replaced_); }

 private:
  void fuse(PointId id, const View& view, const Pose& here_from_there) {
    const MapPoint* there = std::as_const(map_).point(id);
    if (there == nullptr || sees(view.keyframe.id, *there)) return;
    MapPoint here = *there;
    here.position = here_from_there * there->position;
    here.normal = here_from_there.linear() * there->normal;
    const auto feature = find_in(view, here, map_.pyramid(), kAlignedWindowPx);
    if (!feature) return;
    const Measurement measured = view.model.measurement((*view.keyframe.features)[*feature], map_.pyramid());
    const Eigen::Vector3d p = view.camera_from_map * here.position;
    if (view.model.residual(p, measured).squaredNorm() > ObservationModel::chi2(measured)) return;
    connect(id, view.keyframe, *feature);
  }

  void connect(PointId point, const Keyframe& keyframe, std::uint32_t feature) {
    const PointId other = keyframe.points[feature];
    if (other == kNoId) {
      if (map_.observe(point, keyframe.id, feature)) update_from_observations(map_, *map_.point(point));
      return;
    }
    const auto observers = [&](PointId p) { return std::as_const(map_).point(p)->observations.size(); };
    const bool keeps_other =
        observers(other) > observers(point) || (observers(other) == observers(point) && other < point);
    const auto [keep, drop] = keeps_other ? std::pair(other, point) : std::pair(point, other);
    merge_points(map_, keep, drop);
    replaced_[drop] = keep;
  }

  static bool sees(KeyframeId keyframe, const MapPoint& point) {
    const auto place = std::ranges::lower_bound(point.observations, keyframe, {}, &Observation::keyframe);
    return place != point.observations.end() && place->keyframe == keyframe;
  }

  SlamMap& map_;
  ReplacedPoints replaced_;
};

/// What the map's points say of loops.
struct Confirmation {
  bool shares_points = false;          // the two sides of one are joined already
  const LoopMatch* aligned = nullptr;  // the last one whose points agree; of the others nothing is known
  SeenAgain again;                     // of all that agree
};

Confirmation look_at(const SlamMap& map, std::span<const LoopMatch> loops) {
  Confirmation found;
  for (const LoopMatch& loop : loops) {
    if (!is_known(map, loop)) continue;
    const Side earlier = side_of(map, loop.earlier);
    const Side later = side_of(map, loop.later);
    if (share_points(earlier, later)) return {true, nullptr, {}};
    const auto camera_from_map = align(map, loop, earlier, later);
    if (!camera_from_map) continue;
    found.aligned = &loop;
    found.again += see_again(map, earlier.points, *map.keyframe(later.centre), *camera_from_map);
  }
  return found;
}

}  // namespace

bool confirms(const SlamMap& map, std::span<const LoopMatch> loops) {
  const Confirmation found = look_at(map, loops);
  if (found.shares_points || found.aligned == nullptr) return found.shares_points;
  const auto drift = drift_of(map, *found.aligned);
  return found.again.log_odds() + (drift ? drift->log_odds() : 0) >= 0;
}

bool confirms_of_merged_maps(const SlamMap& map, const LoopMatch& loop) {
  const Confirmation found = look_at(map, std::span(&loop, 1));
  return found.shares_points || (found.aligned != nullptr && found.again.log_odds() >= 0);
}

std::optional<ReplacedPoints> join_loop(SlamMap& map, const LoopMatch& loop) {
  if (!is_known(map, loop)) return std::nullopt;
  const Side earlier = side_of(map, loop.earlier);
  const Side later = side_of(map, loop.later);
  if (share_points(earlier, later)) return std::nullopt;
  const auto camera_from_map = align(map, loop, earlier, later);
  if (!camera_from_map) return std::nullopt;
  const Pose map_from_later = std::as_const(map).keyframe(later.centre)->map_from_camera;
  const Pose later_from_earlier = map_from_later * *camera_from_map;
  Fusion fusion(map);
  fusion.fuse(earlier, later, later_from_earlier);
  fusion.fuse(later, earlier, later_from_earlier.inverse());
  for (const KeyframeId id : later.keyframes) update_covisibility(map, id);
  return fusion.take_replaced();
}

}  // namespace rds::tracker
