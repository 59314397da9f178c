// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/objects/object_database.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace rds::mapper {
namespace {

// Log-odds of an object's existence. A sighting outweighs seventeen misses, because a detector finds
// furniture in few of the views that show it; two views through the object outweigh the sighting.
constexpr double kHit = 0.85;  // as of a voxel
constexpr double kMiss = 0.05;
constexpr double kSeenThrough = 0.6;
constexpr double kMaxExistence = 3.5;   // as P = .97 of a voxel: what was removed goes after six views
constexpr double kBorderWeight = 0.25;  // of a sighting that the picture's border cuts
constexpr double kMinOverlap = 0.3;  // 3-D IoU that makes two sightings one object whatever the class radius
constexpr double kSamePlace = 0.5;  // … whatever their labels: two things share less than half of their room
constexpr double kThinnestM = 0.05;           // as a voxel
constexpr std::size_t kMostBeliefs = 4;       // labels that are told of an object
constexpr std::size_t kMostSightings = 1024;  // remembered of an object
constexpr double kOutward = 4;                // a view that shows more of the object counts so often
constexpr double kInward = 0.1;               // one that shows less: every view shows a part only
constexpr double kInViewShare = 0.8;          // of the projected box inside the picture
constexpr double kOcclusionMarginM = 0.15;    // nearer than the object by this: something stands before it
constexpr int kProbes = 5;                    // per side of the projected box

double iou(const geometry::Box3& a, const geometry::Box3& b) {
  const Eigen::Vector3d overlap = (a.max.cwiseMin(b.max) - a.min.cwiseMax(b.min)).cwiseMax(0.0);
  const double common = overlap.prod();
  const double all = a.size().prod() + b.size().prod() - common;
  return all > 0 ? common / all : 0;
}

/// Share of the room of two things that is of both. What was seen from one side alone has no depth yet; it
/// gets some.
double common_room(const geometry::Box3& a, const geometry::Box3& b) {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kThinnestM / 2);
  return iou({a.min - margin, a.max + margin}, {b.min - margin, b.max + margin});
}

/// What the depth picture says about the place of an object.
struct DepthProbes {
  int measured = 0;
  int occluded = 0;
  int seen_through = 0;
};

DepthProbes probe(const geometry::Box2& box, double near_m, double far_m, const ObjectView& view) {
  DepthProbes probes;
  if (view.depth_tenth_mm.empty()) return probes;
  for (int row = 0; row < kProbes; ++row)
    for (int column = 0; column < kProbes; ++column) {
      const double x = box.x0 + box.width() * (column + 0.5) / kProbes;
      const double y = box.y0 + box.height() * (row + 0.5) / kProbes;
      const int px = std::min(view.columns - 1, static_cast<int>(x / view.step_px));
      const int py = std::min(view.rows - 1, static_cast<int>(y / view.step_px));
      const auto i = static_cast<std::size_t>(py * view.columns + px);
      if (view.depth_tenth_mm[i] == 0) continue;
      ++probes.measured;
      const double depth = static_cast<float>(view.depth_tenth_mm[i]) / kTenthMmPerM;
      if (depth < near_m - kOcclusionMarginM || view.is_dynamic[i]) ++probes.occluded;
      if (depth > far_m + kOcclusionMarginM) ++probes.seen_through;
    }
  return probes;
}

}  // namespace

void ObjectDatabase::integrate(const ObjectView& view, const LabelTable& labels) {
  for (auto& entry : entries_) entry.seen_now = false;
  for (std::uint32_t i = 0; i < view.sightings.size(); ++i)
    fuse(view.sightings[i], {view.keyframe_id, i}, view, labels.names()[view.sightings[i].label]);
  merge_duplicates();
  if (!view.looked_for) return;
  for (auto& entry : entries_)
    if (!entry.seen_now && !entry.object.has_gone) fade(entry, view);
  let_go();
}

/// What does not exist any more has gone if it was seen through, else it never was.
void ObjectDatabase::let_go() {
  for (Entry& entry : entries_)
    entry.object.has_gone |= entry.existence <= 0 && entry.object.seen_through > 0 && is_reported(entry);
  std::erase_if(entries_, [](const Entry& e) { return e.existence <= 0 && !e.object.has_gone; });
}

bool ObjectDatabase::is_same(const std::string& label, const geometry::Box3& a,
                             const geometry::Box3& b) const {
  const double radius = config_.labels[label].radius_m;
  return (a.center() - b.center()).norm() < radius || iou(a, b) > kMinOverlap || a.contains(b.center()) ||
         b.contains(a.center());
}

/// The object of which a sighting is: the nearest one with its label, or the one that fills the same place
/// with another, if that overlaps more. Two sightings in one picture are two objects.
ObjectDatabase::Entry* ObjectDatabase::object_of(const std::string& label, const geometry::Box3& box) {
  Entry* nearest = nullptr;
  double distance = std::numeric_limits<double>::infinity();
  Entry* in_its_place = nullptr;
  double overlap = kSamePlace;
  for (auto& entry : entries_) {
    if (entry.seen_now) continue;
    const geometry::Box3 known{entry.min, entry.max};
    const double off = (known.center() - box.center()).norm();
    if (entry.object.label == label && off < distance && is_same(label, known, box)) {
      nearest = &entry;
      distance = off;
    }
    if (entry.object.label != label && common_room(known, box) > overlap) {
      in_its_place = &entry;
      overlap = common_room(known, box);
    }
  }
  const bool is_nearest = in_its_place == nullptr ||
                          (nearest != nullptr && common_room({nearest->min, nearest->max}, box) >= overlap);
  return is_nearest ? nearest : in_its_place;
}

/// Parts of one object that were taken for several before it was seen as a whole, and one object that was
/// seen as two kinds of thing.
void ObjectDatabase::merge_duplicates() {
  for (std::size_t i = 0; i < entries_.size(); ++i)
    for (std::size_t j = entries_.size(); j-- > i + 1;) {
      const Entry& a = entries_[i];
      const Entry& b = entries_[j];
      if (a.object.has_gone || b.object.has_gone || (a.seen_now && b.seen_now)) continue;
      const geometry::Box3 box_a{a.min, a.max};
      const geometry::Box3 box_b{b.min, b.max};
      const bool one = a.object.label == b.object.label ? is_same(a.object.label, box_a, box_b)
                                                        : common_room(box_a, box_b) > kSamePlace;
      if (!one) continue;
      merge(entries_[i], b);
      entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(j));
    }
}

void ObjectDatabase::merge(Entry& into, const Entry& other) {
  const double share = other.weight / (into.weight + other.weight);
  into.min += (other.min - into.min) * share;
  into.max += (other.max - into.max) * share;
  into.weight += other.weight;
  into.score_sum += other.score_sum;
  into.existence = std::max(into.existence, other.existence);
  into.seen_now = into.seen_now || other.seen_now;
  into.labels.add(other.labels);
  into.sightings.insert(into.sightings.end(), other.sightings.begin(), other.sightings.end());
  into.sightings.resize(std::min(into.sightings.size(), kMostSightings));
  into.object.id = std::min(into.object.id, other.object.id);  // the one that is known for longer
  into.object.observations += other.object.observations;
  into.object.first_seen_ns = std::min(into.object.first_seen_ns, other.object.first_seen_ns);
  into.object.last_seen_ns = std::max(into.object.last_seen_ns, other.object.last_seen_ns);
  describe(into);
}

/// What the entry's sums say about its object.
void ObjectDatabase::describe(Entry& entry) {
  auto& object = entry.object;
  object.label = entry.labels.best();
  object.score = static_cast<float>(entry.score_sum / object.observations);
  object.center = (entry.min + entry.max) / 2;
  object.size = entry.max - entry.min;
}

void ObjectDatabase::fuse(const ObjectInPlace& sighting, SightingId id, const ObjectView& view,
                          const std::string& label) {
  const geometry::Box3& box = sighting.box;
  if (!box.min.allFinite() || !box.max.allFinite()) return;
  Entry* entry = object_of(label, box);
  if (entry == nullptr) {
    entry = &entries_.emplace_back();
    entry->object.id = next_id_++;
    entry->object.first_seen_ns = view.stamp_ns;
  }
  const double weight =
      std::max(0.01, double{sighting.score}) * (sighting.cut_by_border ? kBorderWeight : 1.0);
  if (entry->object.has_gone) entry->weight = entry->existence = 0;  // it is back, perhaps not just there
  entry->object.has_gone = false;
  entry->object.seen_through = 0;
  if (entry->weight == 0) {
    entry->min = box.min;
    entry->max = box.max;
  }
  entry->weight += weight;
  const double gain =
      weight / entry->weight;  // every observation counts by its weight, the thousandth as the first
  const auto step = [&](double by, bool outward) {
    return by * std::min(1.0, gain * (outward ? kOutward : kInward));
  };
  for (int axis = 0; axis < 3; ++axis) {
    entry->min[axis] += step(box.min[axis] - entry->min[axis], box.min[axis] < entry->min[axis]);
    entry->max[axis] += step(box.max[axis] - entry->max[axis], box.max[axis] > entry->max[axis]);
  }
  entry->labels.add(label, double{sighting.score});
  if (entry->sightings.size() < kMostSightings) entry->sightings.push_back(id);
  entry->score_sum += sighting.score;
  entry->existence = std::min(kMaxExistence, entry->existence + kHit);
  entry->seen_now = true;
  ++entry->object.observations;
  entry->object.last_seen_ns = std::max(entry->object.last_seen_ns, view.stamp_ns);
  describe(*entry);
}

void ObjectDatabase::fade(Entry& entry, const ObjectView& view) const {
  const geometry::Pose camera_from_map = view.map_from_camera.inverse();
  const geometry::Box3 box{entry.min, entry.max};
  const Eigen::Vector3d center = camera_from_map * box.center();
  if (center.z() <= 0) return;
  const auto in_picture = geometry::project(box, camera_from_map, view.camera);
  if (!in_picture) return;
  geometry::CameraModel wide = view.camera;  // the same projection without the picture's limits
  constexpr int kBorder = 2000;
  wide.width += 2 * kBorder;
  wide.height += 2 * kBorder;
  wide.cx += kBorder;
  wide.cy += kBorder;
  const auto whole = geometry::project(box, camera_from_map, wide);
  if (!whole || in_picture->area() < kInViewShare * whole->area()) return;
  const double half_depth = box.size().norm() / 2;
  const auto probes = probe(*in_picture, center.z() - half_depth, center.z() + half_depth, view);
  if (2 * probes.measured < kProbes * kProbes || 3 * probes.occluded > probes.measured) return;
  const bool is_seen_through = 3 * probes.seen_through > 2 * probes.measured;
  entry.existence -= is_seen_through ? kSeenThrough : kMiss;
  if (is_seen_through) ++entry.object.seen_through;
}

bool ObjectDatabase::is_reported(const Entry& entry) const {
  return entry.object.observations >= static_cast<std::uint32_t>(config_.min_observations) &&
         entry.score_sum >= config_.min_score_sum;
}

std::vector<MapObject> ObjectDatabase::objects() const {
  std::vector<MapObject> reported;
  for (const auto& entry : entries_) {
    if (!is_reported(entry)) continue;
    reported.push_back(entry.object);
    reported.back().labels = entry.labels.beliefs(kMostBeliefs);
  }
  std::ranges::sort(reported, {}, &MapObject::id);
  return reported;
}

}  // namespace rds::mapper
