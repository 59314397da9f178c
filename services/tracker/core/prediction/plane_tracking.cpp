// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/plane_tracking.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace rds::tracker::prediction {
namespace {

constexpr std::size_t kPlanes = 3;
constexpr double kMinIou = 0.3;  // SORT's, in each plane
constexpr double kMaxAgeS = 1;   // a track without a match is forgotten
// SORT's noise is published in pixels and frames of videos: what these are in metres and seconds.
constexpr double kUnitsPerMetre = 200;
constexpr double kFramesPerSecond = 30;

std::size_t after(std::size_t plane, std::size_t steps) {
  return (plane + steps) % kPlanes;
}

Eigen::Index axis(std::size_t i) {
  return static_cast<Eigen::Index>(i % kPlanes);
}

/// Box in the plane (first, second) from intervals of a hull.
geometry::Box2 face(const geometry::Box3& hull, std::size_t first, std::size_t second) {
  return {hull.min[axis(first)], hull.min[axis(second)], hull.max[axis(first)], hull.max[axis(second)]};
}

geometry::Box2 to_plane(const geometry::Box3& hull, std::size_t plane) {
  const geometry::Box2 box = face(hull, plane, plane + 1);
  constexpr double kScale = kUnitsPerMetre;
  return {box.x0 * kScale, box.y0 * kScale, box.x1 * kScale, box.y1 * kScale};
}

Sort make_sort() {
  return Sort({kMinIou, 1, kMaxAgeS * kFramesPerSecond});
}

/// The latest detection's box, moved and stretched as its hull: P_w1 and P_w2 become P_wp1 and P_wp2.
geometry::OrientedBox follow(const geometry::OrientedBox& box, const geometry::Box3& from,
                             const geometry::Box3& to) {
  const Eigen::Vector3d stretch = to.size().cwiseQuotient(from.size());
  const auto moved = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return to.center() + stretch.cwiseProduct(p - from.center());
  };
  const Eigen::Vector3d half(box.size.x() / 2, box.size.y() / 2, 0);
  const Eigen::Vector3d top_left = moved(box.map_from_box * -half);
  const Eigen::Vector3d bottom_right = moved(box.map_from_box * half);
  const Eigen::Vector3d diagonal = box.map_from_box.linear().transpose() * (bottom_right - top_left);
  geometry::OrientedBox result = box;
  result.map_from_box.translation() = (top_left + bottom_right) / 2;
  result.size.head<2>() = diagonal.head<2>().cwiseAbs();
  return result;
}

}  // namespace

PlaneTracking::PlaneTracking()
    : planes_{Plane{make_sort(), {}}, Plane{make_sort(), {}}, Plane{make_sort(), {}}} {}

void PlaneTracking::reset() {
  for (Plane& plane : planes_) plane = {make_sort(), {}};
}

void PlaneTracking::update(std::int64_t stamp_ns, std::span<const ObjectObservation> observations,
                           const KeyframeView* /*view*/) {
  const double frames = seconds_between(state_ns_, stamp_ns) * kFramesPerSecond;
  state_ns_ = stamp_ns;
  std::array<std::vector<std::uint64_t>, kPlanes> track_of;
  for (std::size_t p = 0; p < kPlanes; ++p) {  // lines 1 and 3
    std::vector<geometry::Box2> boxes;
    for (const ObjectObservation& o : observations) boxes.push_back(to_plane(o.box.axis_aligned_hull(), p));
    track_of[p] = planes_[p].sort.update(frames, boxes);
    std::erase_if(planes_[p].latest, [&](const auto& entry) {
      return std::ranges::find(planes_[p].sort.tracks(), entry.first, &Sort::Track::id) ==
             planes_[p].sort.tracks().end();
    });
  }
  std::vector<std::uint64_t> objects;
  for (std::size_t i = 0; i < observations.size(); ++i)
    objects.push_back(object_of({track_of[0][i], track_of[1][i], track_of[2][i]}, objects));
  for (std::size_t p = 0; p < kPlanes; ++p)
    for (std::size_t i = 0; i < observations.size(); ++i)
      planes_[p].latest[track_of[p][i]] = {observations[i], observations[i].box.axis_aligned_hull(),
                                           objects[i], stamp_ns};
}

std::uint64_t PlaneTracking::object_of(const std::array<std::uint64_t, 3>& tracks,
                                       std::span<const std::uint64_t> taken) {
  for (std::size_t p = 0; p < kPlanes; ++p) {
    const auto known = planes_[p].latest.find(tracks[p]);
    if (known == planes_[p].latest.end()) continue;
    if (std::ranges::find(taken, known->second.object_id) == taken.end()) return known->second.object_id;
  }
  return ++last_object_id_;
}

std::vector<PlaneTracking::Prediction> PlaneTracking::predict_plane(std::size_t plane, double frames) const {
  const double scale = kUnitsPerMetre;
  std::vector<Prediction> predictions;
  for (const Sort::Track& track : planes_[plane].sort.tracks()) {
    BoxFilter filter = track.filter;
    if (frames > 0) filter.predict(frames);  // line 5
    if (!filter.is_finite() || track.age + frames > kMaxAgeS * kFramesPerSecond) continue;
    const geometry::Box2 box = filter.box();
    predictions.push_back({{box.x0 / scale, box.y0 / scale, box.x1 / scale, box.y1 / scale},
                           filter.velocity() * (kFramesPerSecond / scale),
                           filter.center_variance() / (scale * scale),
                           &planes_[plane].latest.at(track.id)});
  }
  return predictions;
}

std::vector<PredictedObject> PlaneTracking::predict(std::int64_t stamp_ns) const {
  const double frames = seconds_between(state_ns_, stamp_ns) * kFramesPerSecond;
  std::array<std::vector<Prediction>, kPlanes> predicted;
  for (std::size_t p = 0; p < kPlanes; ++p) predicted[p] = predict_plane(p, frames);
  std::size_t largest = 0;  // line 7
  for (std::size_t p = 1; p < kPlanes; ++p)
    if (predicted[p].size() > predicted[largest].size()) largest = p;
  std::map<std::uint64_t, PredictedObject> objects;
  for (const Prediction& ab : predicted[largest]) {
    PredictedObject object = recombine(ab, largest, predicted);
    object.age_s = seconds_between(ab.latest->stamp_ns, stamp_ns);
    const auto [known, added] = objects.try_emplace(object.id, object);
    if (!added && object.age_s < known->second.age_s) known->second = object;
  }
  std::vector<PredictedObject> result;
  result.reserve(objects.size());
  for (auto& [id, object] : objects) result.push_back(std::move(object));
  return result;
}

PlaneTracking::Depth PlaneTracking::third_axis(const Prediction& ab, std::size_t largest,
                                               const Predictions& predicted) {
  const std::size_t a = largest;
  const std::size_t b = after(a, 1);
  const std::size_t c = after(a, 2);
  const geometry::Box3& own = ab.latest->hull;
  Depth depth{own.min[axis(c)], own.max[axis(c)], 0, ab.variance.mean()};
  double best = 0;
  for (const Prediction& bc : predicted[b]) {  // lines 8 and 10–13: P_bcw(a_l, b, c)
    const geometry::Box3& hull = bc.latest->hull;
    const double overlap =
        geometry::iou(ab.box, {hull.min[axis(a)], bc.box.x0, hull.max[axis(a)], bc.box.x1});
    if (overlap <= best) continue;
    best = overlap;
    depth = {bc.box.y0, bc.box.y1, bc.velocity.y(), bc.variance.y()};
  }
  for (const Prediction& ca : predicted[c]) {  // P_caw(a, b_l, c)
    const geometry::Box3& hull = ca.latest->hull;
    const double overlap =
        geometry::iou(ab.box, {ca.box.y0, hull.min[axis(b)], ca.box.y1, hull.max[axis(b)]});
    if (overlap <= best) continue;
    best = overlap;
    depth = {ca.box.x0, ca.box.x1, ca.velocity.x(), ca.variance.x()};
  }
  return depth;  // line 14
}

PredictedObject PlaneTracking::recombine(const Prediction& ab, std::size_t largest,
                                         const Predictions& predicted) {
  const Eigen::Index a = axis(largest);
  const Eigen::Index b = axis(largest + 1);
  const Eigen::Index c = axis(largest + 2);
  const Depth depth = third_axis(ab, largest, predicted);
  geometry::Box3 hull;
  hull.min[a] = ab.box.x0;
  hull.max[a] = ab.box.x1;
  hull.min[b] = ab.box.y0;
  hull.max[b] = ab.box.y1;
  hull.min[c] = depth.low;
  hull.max[c] = depth.high;
  PredictedObject object;
  object.id = ab.latest->object_id;
  object.label = ab.latest->observation.label;
  object.score = ab.latest->observation.score;
  object.box = follow(ab.latest->observation.box, ab.latest->hull, hull);  // line 16
  object.velocity[a] = ab.velocity.x();
  object.velocity[b] = ab.velocity.y();
  object.velocity[c] = depth.velocity;
  object.covariance_trace = ab.variance.sum() + depth.variance;
  return object;
}

}  // namespace rds::tracker::prediction
