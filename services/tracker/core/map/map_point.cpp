// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/map_point.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "services/tracker/core/map/slam_map.hpp"

namespace rds::tracker {
namespace {

constexpr std::size_t kMaxTypicalOf = 12;  // newest observations that the descriptor is chosen from

/// The descriptor whose median distance to the others is smallest.
const Descriptor& most_typical(std::span<const Descriptor* const> descriptors) {
  const std::size_t count = descriptors.size();
  std::array<std::array<int, kMaxTypicalOf>, kMaxTypicalOf> distances{};
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < i; ++j)
      distances[i][j] = distances[j][i] = descriptor_distance(*descriptors[i], *descriptors[j]);
  const auto median = [count](std::array<int, kMaxTypicalOf>& row) {
    const auto middle = row.begin() + static_cast<std::ptrdiff_t>((count - 1) / 2);
    std::nth_element(row.begin(), middle, row.begin() + static_cast<std::ptrdiff_t>(count));
    return *middle;
  };
  std::array<int, kMaxTypicalOf> medians{};
  for (std::size_t i = 0; i < count; ++i) medians[i] = median(distances[i]);
  const auto best = std::min_element(medians.begin(), medians.begin() + static_cast<std::ptrdiff_t>(count));
  return *descriptors[static_cast<std::size_t>(best - medians.begin())];
}

}  // namespace

void update_view(const SlamMap& map, MapPoint& point) {
  if (point.observations.empty()) return;
  Eigen::Vector3d directions = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < point.observations.size(); ++i) {
    const Keyframe* k = map.keyframe(point.observations[i].keyframe);
    const Eigen::Vector3d ray = point.position - k->map_from_camera.translation();
    const double distance = ray.norm();
    if (distance > 0) directions += ray / distance;
    if (i == 0)
      point.level_0_distance =
          distance * map.pyramid().scale((*k->features)[point.observations[i].feature].level);
  }
  point.normal = directions.normalized();
}

void update_from_observations(const SlamMap& map, MapPoint& point) {
  update_view(map, point);
  if (point.observations.empty()) return;
  std::array<const Descriptor*, kMaxTypicalOf> newest{};
  const std::size_t count = std::min(point.observations.size(), kMaxTypicalOf);
  std::transform(
      point.observations.end() - static_cast<std::ptrdiff_t>(count), point.observations.end(), newest.begin(),
      [&map](const Observation& o) { return &(*map.keyframe(o.keyframe)->features)[o.feature].descriptor; });
  point.descriptor = most_typical(std::span(newest).first(count));
}

}  // namespace rds::tracker
