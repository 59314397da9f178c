// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/evidence/dynamic_history.hpp"
#include "services/mapper/core/evidence/static_history.hpp"

namespace rds::mapper {

/// Where and when keyframes have seen something static, and something dynamic.
struct SceneHistory {
  StaticHistory statics;
  DynamicHistory dynamics;

  void see(const KeyframeRecord& record, const MapperConfig& config) {
    statics.see(record, config);
    dynamics.see(record, config);
  }

  /// Static in fewer keyframes than dynamic, and in none later than the one that asks. @param time_ns  of the keyframe that asks.
  [[nodiscard]] bool is_ghost(const octomap::OcTreeKey& key, std::int64_t time_ns) const;

  /// Static only at times at which others saw something dynamic there, and in fewer keyframes.
  /// @param apart_ns  so long before the first dynamic sighting or after the last one a
  /// static one is at another time.
  [[nodiscard]] bool is_transient(const octomap::OcTreeKey& key, std::int64_t apart_ns) const;
};

}  // namespace rds::mapper
