// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/evidence/movable_history.hpp"
#include "services/mapper/core/evidence/surface_history.hpp"

namespace rds::mapper {

/// Where keyframes have seen something static, and where something movable.
struct SceneHistory {
  SurfaceHistory surfaces;
  MovableHistory movable;

  void see(const KeyframeRecord& record, const MapperConfig& config) {
    surfaces.see(record, config);
    movable.see(record, config);
  }

  /// True if what was taken for static in a voxel may be something movable that has gone: movable things have
  /// been there, too, nothing static is seen there after `time_ns`, and it was seen in fewer keyframes than
  /// they were.
  [[nodiscard]] bool is_suspect(const octomap::OcTreeKey& key, std::int64_t time_ns) const;

  /// True if what is taken for static in a voxel is something movable that some keyframes do not know: seen
  /// while movable things are there, neither so long before nor after, and in fewer keyframes.
  [[nodiscard]] bool is_passing(const octomap::OcTreeKey& key, std::int64_t apart_ns) const;
};

}  // namespace rds::mapper
