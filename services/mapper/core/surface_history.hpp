// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unordered_map>

#include "services/mapper/core/mapper_config.hpp"
#include "services/mapper/core/voxel_projector.hpp"

namespace rds::mapper {

/// When something static was seen in a voxel: for the first and for the last time.
class SurfaceHistory {
 public:
  /// The static pixels of a keyframe, where its pose puts them.
  void see(const KeyframeRecord& record, const MapperConfig& config);
  /// A voxel of a saved map: it has always been there.
  void know(const octomap::OcTreeKey& key);

  /// True if it was seen at least so long before or after this time.
  [[nodiscard]] bool seen_apart(const octomap::OcTreeKey& key, std::int64_t stamp_ns,
                                std::int64_t apart_ns) const;

 private:
  struct Span {
    std::int64_t first_ns;
    std::int64_t last_ns;
  };
  std::unordered_map<std::uint64_t, Span> spans_;  // looked up by key only: its order means nothing
};

}  // namespace rds::mapper
