// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/triangulation/epipolar_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/tracker/core/pose/association.hpp"

namespace rds::tracker {
namespace {

constexpr double kMaxRatio = 0.8;    // of the nearest descriptor's distance to that of another corner
constexpr double kSameCornerPx = 3;  // at level 0: features nearer to each other are of one corner

using Alike = std::vector<std::pair<int, std::uint32_t>>;  // distance of descriptors, feature

double square(double x) {
  return x * x;
}

/// Features of one thing show at levels that its distances explain.
bool fits_scale(const ScalePyramid& pyramid, const Feature& a, double distance_a, const Feature& b,
                double distance_b) {
  return std::abs(pyramid.predict(distance_a * pyramid.scale(a.level), distance_b) - b.level) <= 1;
}

/// Before both cameras, at distances that the features' scales explain. @param t  where the ray begins.
bool can_meet(const ScalePyramid& pyramid, const Feature& feature, const Eigen::Vector3d& ray,
              const Eigen::Vector3d& t, const Feature& candidate, const Eigen::Vector3d& candidate_ray) {
  const Eigen::Vector3d across = candidate_ray.cross(ray);  // z · ray + t is along candidate_ray
  const double z = t.cross(candidate_ray).dot(across) / across.squaredNorm();
  const Eigen::Vector3d point = z * ray + t;
  return z >= kMinDepth && point.z() >= kMinDepth &&
         fits_scale(pyramid, feature, z * ray.norm(), candidate, point.norm());
}

std::optional<std::uint32_t> only_best(const ScalePyramid& pyramid, const SearchView& view,
                                       const Alike& alike) {
  const auto best = std::ranges::min_element(alike);
  if (best == alike.end() || best->first > kMaxDistanceAlone) return std::nullopt;
  const Feature& found = view.feature(best->second);
  const double same_corner_px = kSameCornerPx * pyramid.scale(found.level);
  for (const auto& [distance, i] : alike)
    if (best->first > kMaxRatio * distance && (view.feature(i).px - found.px).norm() > same_corner_px)
      return std::nullopt;
  return best->second;
}

}  // namespace

std::optional<std::uint32_t> find_along_line(const ScalePyramid& pyramid, const SearchView& from,
                                             const FreeFeature& f, const SearchView& into) {
  const Feature& feature = from.feature(f.index);
  const geometry::Pose into_from_from = into.camera_from_map * from.camera_from_map.inverse();
  const Eigen::Vector3d& t = into_from_from.translation();
  const Eigen::Vector3d ray = into_from_from.linear() * f.ray;
  const Eigen::Vector3d normal = t.cross(ray);
  if (normal.isZero()) return std::nullopt;
  const Eigen::Vector3d line =  // its product with a ray is the distance in pixels
      normal * (into.model.distance_px(normal, normal) / normal.squaredNorm());
  Alike alike;
  for (const FreeFeature& c : into.free) {
    const Feature& candidate = into.feature(c.index);
    const double variance = square(pyramid.scale(feature.level)) + square(pyramid.scale(candidate.level));
    if (square(line.dot(c.ray)) > square(kSigmas95) * variance || into.taken[c.index] != kNoId) continue;
    if (!can_meet(pyramid, feature, ray, t, candidate, c.ray)) continue;
    alike.emplace_back(descriptor_distance(feature.descriptor, candidate.descriptor), c.index);
  }
  return only_best(pyramid, into, alike);
}

}  // namespace rds::tracker
