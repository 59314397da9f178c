// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/new_points.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "services/tracker/core/mapping/triangulation.hpp"
#include "services/tracker/core/motion/rolling_shutter.hpp"
#include "services/tracker/core/motion/se3.hpp"
#include "services/tracker/core/pose/association.hpp"

namespace rds::tracker {
namespace {

constexpr std::size_t kNeighbours = 10;    // keyframes that share most points with the centre
constexpr double kSigmas = 1.96;           // 95 % of a normal distribution
constexpr double kMaxRatio = 0.8;          // of the nearest descriptor's distance to that of another corner
constexpr double kSameCornerPx = 3;        // at level 0: features nearer to each other are of one corner
constexpr double kMaxWindowPx = 10;        // at level 0; a position known worse leads to no third view
constexpr double kAlikeCosine = 0.94;      // 20°: from more aside it may look otherwise, or be hidden
constexpr double kAlikeDistance = 1.3;     // times nearer or farther, likewise
constexpr double kMinInformation = 0.1;    // of what is needed: a pair with less leads to no third view
constexpr PointId kTaken = 0;              // any but kNoId

// Of a whole sensor .12 of the features have no depth: triangulated points add nothing to its map, and where
// depth is not registered well to colour they contradict it. Of one that ends at 2.5 m .3 to .7 have none.
constexpr double kFewWithoutDepth = 0.2;

double square(double x) { return x * x; }

bool lacks_depth(const MappingKeyframe& keyframe) {
  int all = 0;
  int without = 0;
  for (std::size_t i = 0; i < keyframe.features->size(); ++i) {
    if (keyframe.movable[i]) continue;
    ++all;
    without += (*keyframe.features)[i].depth_m > 0 ? 0 : 1;
  }
  return without > kFewWithoutDepth * all;
}

/// A feature that sees no point yet.
struct FreeFeature {
  std::uint32_t index;
  Eigen::Vector3d ray;  // z = 1; where the middle row would see what is far away
};

/// A keyframe where bundle adjustment has put it.
struct View {
  const MappingKeyframe& keyframe;
  Pose camera_from_map;
  ObservationModel model;
  std::vector<PointId> taken;  // per feature: kNoId if it may see a new point
  std::vector<FreeFeature> free;
  double readout_s;  // of the camera, as far as known
  Eigen::Vector3d camera_in_map;

  void list_free() {
    for (std::uint32_t i = 0; i < taken.size(); ++i)
      if (taken[i] == kNoId) free.push_back({i, ray(i)});
  }
  [[nodiscard]] const Feature& feature(std::uint32_t i) const { return (*keyframe.features)[i]; }
  /// The camera's motion between the middle row and the feature's that the feature is not compensated for.
  [[nodiscard]] Twist moved(std::uint32_t i) const {
    const ShutterMotion& motion = keyframe.motion;
    Twist compensated = motion.velocity;
    if (!(feature(i).depth_m > 0)) compensated.head<3>().setZero();
    return row_share(keyframe.features->camera(), static_cast<double>(feature(i).image_px.y())) *
           (readout_s * motion.velocity - motion.readout_s * compensated);
  }
  /// From where the feature's row was read.
  [[nodiscard]] PointView see(std::uint32_t i, const ScalePyramid& pyramid) const {
    return {se3_exp(moved(i)) * camera_from_map, model, model.measurement(feature(i), pyramid)};
  }
  [[nodiscard]] Eigen::Vector3d ray(std::uint32_t i) const {
    const Eigen::Vector3d seen = model.ray(feature(i).px.cast<double>());
    const Eigen::Vector3d there = seen - moved(i).tail<3>().cross(seen);
    return there / there.z();
  }
};

struct Seen {
  std::size_t view = 0;
  std::uint32_t feature = 0;
};

std::vector<View> views_of(const MappingScene& scene, const LocalMappingResult& result) {
  std::map<KeyframeId, Pose> moved;
  for (const auto& k : result.keyframes) moved[k.id] = k.map_from_camera;
  std::vector<View> views;
  for (std::size_t k = 0; k < scene.job().keyframes.size(); ++k) {
    const MappingKeyframe& keyframe = scene.job().keyframes[k];
    const auto place = moved.find(keyframe.id);
    const Pose& map_from_camera = place == moved.end() ? keyframe.map_from_camera : place->second;
    const ObservationModel model(known_camera(keyframe, scene.job()));
    View view{keyframe,        map_from_camera.inverse(),
              model,           scene.seen()[k],
              {},              scene.job().readout_s,
              map_from_camera.translation()};
    for (std::uint32_t i = 0; i < view.taken.size(); ++i)
      if (keyframe.movable[i] || !view.feature(i).matchable) view.taken[i] = kTaken;
    views.push_back(std::move(view));
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
      const auto other = find_along_line(f, n);
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
    const View& centre = views_[centre_];
    const Eigen::Vector3d ray = (centre.camera_from_map.linear().transpose() * f.ray).normalized();
    const double level_scale = pyramid_.scale(centre.feature(f.index).level);
    const double needed_m = ObservationModel::kBaselineM * level_scale / kDisparitySigmaPx;
    std::vector<double> informations;
    for (const View& view : views_) {
      const double distance_m = (view.camera_in_map - centre.camera_in_map).cross(ray).norm();
      informations.push_back(std::pow(distance_m / needed_m, 2));
    }
    return informations;
  }

  /// The feature of view n on the epipolar line of the centre's that looks like it, if no other does.
  [[nodiscard]] std::optional<std::uint32_t> find_along_line(const FreeFeature& f, std::size_t n) const {
    const View& from = views_[centre_];
    const View& into = views_[n];
    const Feature& feature = from.feature(f.index);
    const Pose into_from_from = into.camera_from_map * from.camera_from_map.inverse();
    const Eigen::Vector3d& t = into_from_from.translation();
    const Eigen::Vector3d ray = into_from_from.linear() * f.ray;
    const Eigen::Vector3d normal = t.cross(ray);
    if (normal.isZero()) return std::nullopt;
    const Eigen::Vector3d line =  // its product with a ray is the distance in pixels
        normal * (into.model.distance_px(normal, normal) / normal.squaredNorm());
    std::vector<std::pair<int, std::uint32_t>> alike;
    for (const FreeFeature& c : into.free) {
      const Feature& candidate = into.feature(c.index);
      const double variance = square(pyramid_.scale(feature.level)) + square(pyramid_.scale(candidate.level));
      if (square(line.dot(c.ray)) > kSigmas * kSigmas * variance || into.taken[c.index] != kNoId) continue;
      if (!can_meet(feature, ray, t, candidate, c.ray)) continue;
      alike.emplace_back(descriptor_distance(feature.descriptor, candidate.descriptor), c.index);
    }
    return only_best(into, alike);
  }

  /// Before both cameras, at distances that the features' scales explain. @param t  where the ray begins.
  [[nodiscard]] bool can_meet(const Feature& feature, const Eigen::Vector3d& ray, const Eigen::Vector3d& t,
                              const Feature& candidate, const Eigen::Vector3d& candidate_ray) const {
    const Eigen::Vector3d across = candidate_ray.cross(ray);  // z · ray + t is along candidate_ray
    const double z = t.cross(candidate_ray).dot(across) / across.squaredNorm();
    const Eigen::Vector3d point = z * ray + t;
    return z >= kMinDepth && point.z() >= kMinDepth &&
           fits_scale(feature, z * ray.norm(), candidate, point.norm());
  }

  [[nodiscard]] std::optional<std::uint32_t> only_best(
      const View& view, const std::vector<std::pair<int, std::uint32_t>>& alike) const {
    const auto best = std::ranges::min_element(alike);
    if (best == alike.end() || best->first > kMaxDistanceAlone) return std::nullopt;
    const Feature& found = view.feature(best->second);
    const double same_corner_px = kSameCornerPx * pyramid_.scale(found.level);
    for (const auto& [distance, i] : alike)
      if (best->first > kMaxRatio * distance && (view.feature(i).px - found.px).norm() > same_corner_px)
        return std::nullopt;
    return best->second;
  }

  /// Features of one thing show at levels that its distances explain.
  [[nodiscard]] bool fits_scale(const Feature& a, double distance_a, const Feature& b,
                                double distance_b) const {
    return std::abs(pyramid_.predict(distance_a * pyramid_.scale(a.level), distance_b) - b.level) <= 1;
  }

  /// @return views that should show the point, besides those two that it comes from.
  std::size_t find_in_others(const TriangulatedPoint& point, std::vector<Seen>& seen) const {
    const Feature& feature = views_[centre_].feature(seen[0].feature);
    const std::size_t first = seen[1].view;
    std::size_t expected = 0;
    for (std::size_t k = 0; k < views_.size(); ++k) {
      if (k == centre_ || k == first) continue;
      const View& view = views_[k];
      const auto window = window_of(point, feature, view);
      if (!window) continue;
      expected += shows_alike(point.position, view) ? 1U : 0U;
      const auto found = best_in_window(*view.keyframe.features, view.taken, view.model, feature.descriptor,
                                        *window, kMaxDistanceAlone, 1);
      if (found) seen.push_back({k, *found});
    }
    return expected;
  }

  /// Where a view should show the point that the centre's feature sees; nothing if it does not, or if that is
  /// known too badly to look for it.
  [[nodiscard]] std::optional<SearchWindow> window_of(const TriangulatedPoint& point, const Feature& feature,
                                                      const View& view) const {
    const Eigen::Vector3d p = view.camera_from_map * point.position;
    if (p.z() < kMinDepth) return std::nullopt;
    const Eigen::Vector2d px = view.model.project(p);
    if (!view.keyframe.features->sees(px)) return std::nullopt;
    const double distance = (views_[centre_].camera_from_map * point.position).norm();
    const int level = pyramid_.predict(distance * pyramid_.scale(feature.level), p.norm());
    const double scale = pyramid_.scale(level);
    const double radius =
        kSigmas * std::hypot(scale, pixel_sigma_px(point, view.camera_from_map, view.model));
    if (radius > kMaxWindowPx * scale) return std::nullopt;
    return SearchWindow{px.cast<float>(), static_cast<float>(radius), level - 1, level + 1,
                        view.model.disparity(p.z())};
  }

  /// From a similar distance and direction.
  [[nodiscard]] bool shows_alike(const Eigen::Vector3d& position, const View& view) const {
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
      made.seen.push_back({views_[s.view].keyframe.id, s.feature});
    }
    result_.made.push_back(std::move(made));
  }

  const ScalePyramid& pyramid_;
  LocalMappingResult& result_;
  std::vector<View> views_;  // as job.keyframes
  std::size_t centre_;
  std::vector<std::size_t> neighbours_;  // of the centre
};

}  // namespace

bool rests_on_views(const SlamMap& map, const MapPoint& point) {
  return point.is_triangulated && std::ranges::none_of(point.observations, [&](const Observation& o) {
    return (*map.keyframe(o.keyframe)->features)[o.feature].depth_m > 0;
  });
}

void erase_if_unknown(SlamMap& map, PointId id) {
  const MapPoint* point = std::as_const(map).point(id);
  if (point == nullptr || !rests_on_views(map, *point)) return;
  std::vector<PointView> views;
  for (const Observation& o : point->observations) {
    const Keyframe& k = *std::as_const(map).keyframe(o.keyframe);
    const ObservationModel model(k.features->camera());
    views.push_back(
        {k.map_from_camera.inverse(), model, model.measurement((*k.features)[o.feature], map.pyramid())});
  }
  const bool is_known = views.size() >= kMinTriangulatingViews &&
                        is_known_well({point->position, covariance_at(views, point->position)}, views.back());
  if (!is_known) map.erase_point(id);
}

void triangulate_points(const MappingScene& scene, LocalMappingResult& result) {
  const auto centre = scene.keyframe_index(scene.job().keyframe);
  if (centre && lacks_depth(scene.job().keyframes[*centre]))
    PointMaker(scene, result, *centre).make_points();
}

}  // namespace rds::tracker
