// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "services/mapper/core/config/mapper_config.hpp"
#include "services/mapper/core/keyframe/voxel_projector.hpp"

namespace rds::mapper {

/// Times [ns] before and after all others; their differences from others do not overflow.
inline constexpr std::int64_t kBeforeAll = std::numeric_limits<std::int64_t>::min() / 2;
inline constexpr std::int64_t kAfterAll = std::numeric_limits<std::int64_t>::max() / 2;

/// When, and in how many keyframes, something was seen in one place; default: in none.
struct PlaceSightings {
  std::int64_t first_ns = kAfterAll;
  std::int64_t last_ns = kBeforeAll;
  std::int64_t counted_ns = kBeforeAll;  // of the keyframe counted last: its pixels come in one go
  std::uint32_t keyframes = 0;

  void add(std::int64_t time_ns) {
    first_ns = std::min(first_ns, time_ns);
    last_ns = std::max(last_ns, time_ns);
    keyframes += time_ns == counted_ns ? 0 : 1;
    counted_ns = time_ns;
  }
};

/// When and how often static pixels were seen in a voxel.
class StaticHistory {
 public:
  /// Adds the static pixels of a keyframe, where its pose puts them.
  void see(const KeyframeRecord& record, const MapperConfig& config);
  /// Adds a voxel of a saved map: it counts as seen at all times.
  void know(const octomap::OcTreeKey& key);

  /// True if it was seen at least so long before or after this time.
  [[nodiscard]] bool seen_apart(const octomap::OcTreeKey& key, std::int64_t time_ns,
                                std::int64_t apart_ns) const;
  /// nullptr if there are none.
  [[nodiscard]] const PlaceSightings* sightings(const octomap::OcTreeKey& key) const;

 private:
  std::unordered_map<std::uint64_t, PlaceSightings> voxels_;  // by key only: their order means nothing
};

/// When and how often boxes or the tracker have told of something dynamic in a place, in cubes of about 10
/// cm: a standing person moves by less.
class DynamicHistory {
 public:
  explicit DynamicHistory(double resolution_m);

  /// Adds the dynamic pixels of a keyframe, where its pose puts them.
  void see(const KeyframeRecord& record, const MapperConfig& config);

  [[nodiscard]] bool empty() const { return cubes_.empty(); }
  /// In the voxel's cube or half a cube beside it; nullptr if there are none.
  [[nodiscard]] const PlaceSightings* sightings(const octomap::OcTreeKey& key) const;

 private:
  [[nodiscard]] std::uint64_t cube(const octomap::OcTreeKey& key) const {
    return packed({static_cast<std::uint16_t>(key[0] >> cube_bits_),
                   static_cast<std::uint16_t>(key[1] >> cube_bits_),
                   static_cast<std::uint16_t>(key[2] >> cube_bits_)});
  }
  void see_around(const octomap::OcTreeKey& key, std::int64_t time_ns);

  int cube_bits_;                                            // voxels of a cube's side, log2
  std::unordered_map<std::uint64_t, PlaceSightings> cubes_;  // by key only: their order means nothing
};

/// Where and when keyframes have seen something static, and something dynamic.
struct SceneHistory {
  StaticHistory statics;
  DynamicHistory dynamics;

  void see(const KeyframeRecord& record, const MapperConfig& config) {
    statics.see(record, config);
    dynamics.see(record, config);
  }

  /// A ghost was static in fewer keyframes than dynamic, and in none later than the one that asks.
  /// @param time_ns  of the keyframe that asks.
  [[nodiscard]] bool is_ghost(const octomap::OcTreeKey& key, std::int64_t time_ns) const;

  /// A transient voxel was static only at times at which others saw something dynamic there, and in fewer
  /// keyframes. @param apart_ns  so long before the first dynamic sighting or after the last one a static one
  /// is at another time.
  [[nodiscard]] bool is_transient(const octomap::OcTreeKey& key, std::int64_t apart_ns) const;
};

}  // namespace rds::mapper
