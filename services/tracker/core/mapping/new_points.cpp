// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/new_points.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "services/tracker/core/pose/association.hpp"
#include "services/tracker/core/triangulation/epipolar_search.hpp"
#include "services/tracker/core/triangulation/triangulated_points.hpp"
#include "services/tracker/core/triangulation/triangulation.hpp"

namespace rds::tracker {
namespace {

constexpr std::size_t kNeighbours = 10;    // keyframes that share most points with the centre
constexpr double kMaxWindowPx = 10;        // at level 0; a position known worse leads to no third view
constexpr double kAlikeCosine = 0.94;      // 20°: from more aside it may look otherwise, or be hidden
constexpr double kAlikeDistance = 1.3;     // times nearer or farther, likewise
constexpr double kMinInformation = 0.1;    // of what is needed: a pair with less leads to no third view
constexpr PointId kTaken = 0;              // any but kNoId

// Where at least every other feature has depth, triangulated points add nothing to the map, and contradict
// what is measured: in corridors, where a sensor does not see the end, as where depth lies beside its colour.
constexpr double kMostly = 0.5;

bool lacks_depth(const MappingKeyframe& keyframe) {
  int all = 0;
  int without = 0;
  for (std::size_t i = 0; i < keyframe.features->size(); ++i) {
    if (keyframe.movable[i]) continue;
    ++all;
    without += (*keyframe.features)[i].depth_m > 0 ? 0 : 1;
  }
  return without > kMostly * all;
}

struct Seen {
  std::size_t view = 0;
  std::uint32_t feature = 0;
};

/// Keyframes where bundle adjustment has put them.
std::vector<SearchView> views_of(const MappingScene& scene, const LocalMappingResult& result) {
  std::map<KeyframeId, Pose> moved;
  for (const auto& k : result.keyframes) moved[k.id] = k.map_from_camera;
  std::vector<SearchView> views;
  for (std::size_t k = 0; k < scene.job().keyframes.size(); ++k) {
    const MappingKeyframe& keyframe = scene.job().keyframes[k];
    const auto place = moved.find(keyframe.id);
    const Pose& map_from_camera = place == moved.end() ? keyframe.map_from_camera : place->second;
    SearchView& view =
        views.emplace_back(SearchView{*keyframe.features, keyframe.motion, scene.job().readout_s,
                                      ObservationModel(known_camera(keyframe, scene.job())),
                                      map_from_camera.inverse(), map_from_camera.translation(),
                                      scene.seen()[k]});
    for (std::uint32_t i = 0; i < view.taken.size(); ++i)
      if (keyframe.movable[i] || !view.feature(i).matchable) view.taken[i] = kTaken;
  }
  return views;
}

/// Those that share most points with the centre, without it.
std::vector<std::size_t> neighbours_of(const MappingScene& scene, std::size_t centre) {
  std::vector<std::pair<int, std::size_t>> shared(scene.seen().size());
  for (std::size_t k = 0; k < shared.size(); ++k) shared[k].second = k;
  for (std::size_t p = 0; p < scene.points().size(); ++p)
    if (scene.points()[p].alive && scene.sees(centre, p))
      for (const auto& o : scene.points()[p].observations) ++shared[o.keyframe].first;
  std::ranges::stable_sort(shared, std::ranges::greater{}, &std::pair<int, std::size_t>::first);
  std::vector<std::size_t> neighbours;
  for (const auto& [count, k] : shared)
    if (k != centre && count > 0 && neighbours.size() < kNeighbours) neighbours.push_back(k);
  return neighbours;
}

class PointMaker {
 public:
  PointMaker(const MappingScene& scene, LocalMappingResult& result, std::size_t centre)
      : pyramid_(scene.job().pyramid),
        keyframes_(scene.job().keyframes),
        result_(result),
        views_(views_of(scene, result)),
        centre_(centre),
        neighbours_(neighbours_of(scene, centre)) {
    views_[centre].list_free();
    for (const std::size_t n : neighbours_) views_[n].list_free();
  }

  void make_points() {
    for (const FreeFeature& f : views_[centre_].free)
      if (!(views_[centre_].feature(f.index).depth_m > 0)) make_point(f);
  }

 private:
  void make_point(const FreeFeature& f) {
    const std::vector<double> informations = informations_of(f);
    if (std::accumulate(informations.begin(), informations.end(), 0.0) < 1) return;
    for (const std::size_t n : neighbours_) {
      if (informations[n] < kMinInformation) continue;
      const auto other = find_along_line(pyramid_, views_[centre_], f, views_[n]);
      if (!other) continue;
      std::vector<Seen> seen{{centre_, f.index}, {n, *other}};
      const auto guess = triangulate(see(seen));
      if (!guess || !all_agree(seen, guess->position)) continue;
      const std::size_t expected = seen.size() + find_in_others(*guess, seen);
      const auto point = confirmed(seen);
      if (point && 2 * seen.size() > expected) return keep(*point, seen);
    }
  }

  /// At most what each view can tell of the feature's point, as a share of what is needed: of the ray's
  /// distance B from the view's camera, b σ_px / B is the disparity's standard deviation at any depth.
  [[nodiscard]] std::vector<double> informations_of(const FreeFeature& f) const {
    const SearchView& centre = views_[centre_];
    const Eigen::Vector3d ray = (centre.camera_from_map.linear().transpose() * f.ray).normalized();
    const double level_scale = pyramid_.scale(centre.feature(f.index).level);
    const double needed_m = ObservationModel::kBaselineM * level_scale / kDisparitySigmaPx;
    std::vector<double> informations;
    for (const SearchView& view : views_) {
      const double distance_m = (view.camera_in_map - centre.camera_in_map).cross(ray).norm();
      informations.push_back(std::pow(distance_m / needed_m, 2));
    }
    return informations;
  }

  /// @return views that should show the point, besides those two that it comes from.
  std::size_t find_in_others(const TriangulatedPoint& point, std::vector<Seen>& seen) const {
    const Feature& feature = views_[centre_].feature(seen[0].feature);
    const std::size_t first = seen[1].view;
    std::size_t expected = 0;
    for (std::size_t k = 0; k < views_.size(); ++k) {
      if (k == centre_ || k == first) continue;
      const SearchView& view = views_[k];
      const auto window = window_of(point, feature, view);
      if (!window) continue;
      expected += shows_alike(point.position, view) ? 1U : 0U;
      const auto found = best_in_window(view.features, view.taken, view.model, feature.descriptor,
                                        *window, kMaxDistanceAlone, 1);
      if (found) seen.push_back({k, *found});
    }
    return expected;
  }

  /// Where a view should show the point that the centre's feature sees; nothing if it does not, or if that is
  /// known too badly to look for it.
  [[nodiscard]] std::optional<SearchWindow> window_of(const TriangulatedPoint& point, const Feature& feature,
                                                      const SearchView& view) const {
    const Eigen::Vector3d p = view.camera_from_map * point.position;
    if (p.z() < kMinDepth) return std::nullopt;
    const Eigen::Vector2d px = view.model.project(p);
    if (!view.features.sees(px)) return std::nullopt;
    const double distance = (views_[centre_].camera_from_map * point.position).norm();
    const int level = pyramid_.predict(distance * pyramid_.scale(feature.level), p.norm());
    const double scale = pyramid_.scale(level);
    const double radius =
        kSigmas95 * std::hypot(scale, pixel_sigma_px(point, view.camera_from_map, view.model));
    if (radius > kMaxWindowPx * scale) return std::nullopt;
    return SearchWindow{px.cast<float>(), static_cast<float>(radius), level - 1, level + 1,
                        view.model.disparity(p.z())};
  }

  /// From a similar distance and direction.
  [[nodiscard]] bool shows_alike(const Eigen::Vector3d& position, const SearchView& view) const {
    const Eigen::Vector3d from_centre = position - views_[centre_].camera_in_map;
    const Eigen::Vector3d from_there = position - view.camera_in_map;
    const double ratio = from_there.norm() / from_centre.norm();
    return from_centre.dot(from_there) > kAlikeCosine * from_centre.norm() * from_there.norm() &&
           ratio < kAlikeDistance && ratio * kAlikeDistance > 1;
  }

  /// The point by all views that agree; nothing if they are too few, or it is not known well enough.
  [[nodiscard]] std::optional<TriangulatedPoint> confirmed(std::vector<Seen>& seen) const {
    if (seen.size() < kMinTriangulatingViews) return std::nullopt;
    auto point = triangulate(see(seen));
    if (!point) return std::nullopt;
    const std::size_t all = seen.size();
    std::erase_if(seen, [&](const Seen& s) { return !agrees(see(s), point->position); });
    if (seen.size() < kMinTriangulatingViews || seen.front().view != centre_) return std::nullopt;
    if (seen.size() < all) point = triangulate(see(seen));
    if (!point || !all_agree(seen, point->position)) return std::nullopt;
    return is_known_well(*point, see(seen.front())) ? point : std::nullopt;
  }

  [[nodiscard]] PointView see(const Seen& s) const { return views_[s.view].see(s.feature, pyramid_); }
  [[nodiscard]] std::vector<PointView> see(const std::vector<Seen>& seen) const {
    std::vector<PointView> views;
    for (const Seen& s : seen) views.push_back(see(s));
    return views;
  }
  [[nodiscard]] bool all_agree(const std::vector<Seen>& seen, const Eigen::Vector3d& position) const {
    return std::ranges::all_of(seen, [&](const Seen& s) { return agrees(see(s), position); });
  }

  void keep(const TriangulatedPoint& point, const std::vector<Seen>& seen) {
    LocalMappingResult::MadePoint made{point.position, {}};
    for (const Seen& s : seen) {
      views_[s.view].taken[s.feature] = kTaken;
      made.seen.push_back({keyframes_[s.view].id, s.feature});
    }
    result_.made.push_back(std::move(made));
  }

  const ScalePyramid& pyramid_;
  const std::vector<MappingKeyframe>& keyframes_;
  LocalMappingResult& result_;
  std::vector<SearchView> views_;  // as keyframes_
  std::size_t centre_;
  std::vector<std::size_t> neighbours_;  // of the centre
};

}  // namespace

void triangulate_points(const MappingScene& scene, LocalMappingResult& result) {
  const auto centre = scene.keyframe_index(scene.job().keyframe);
  if (centre && lacks_depth(scene.job().keyframes[*centre]))
    PointMaker(scene, result, *centre).make_points();
}

}  // namespace rds::tracker
