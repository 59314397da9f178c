// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/movable_history.hpp"
#include "services/mapper/core/surface_history.hpp"

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
  /// been there, too, nothing static is seen there after `stamp_ns`, and it was seen in fewer than twice as
  /// many keyframes as they were.
  [[nodiscard]] bool is_suspect(const octomap::OcTreeKey& key, std::int64_t stamp_ns) const;
};

}  // namespace rds::mapper
