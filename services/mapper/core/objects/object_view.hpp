// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// What the object database needs of a keyframe: its sightings, and a coarse depth picture that tells whether
/// what is not detected is hidden, gone or overlooked. Kept for each keyframe, a few kB.
struct ObjectView {
  static constexpr int kProbeStep = 8;  // every so many sampled pixels one probe

  /// @param record  classified, its objects labelled.
  static ObjectView of(const KeyframeRecord& record);

  std::uint64_t keyframe_id = 0;
  std::int64_t stamp_ns = 0;
  geometry::Pose map_from_camera = geometry::Pose::Identity();
  geometry::CameraModel camera;
  bool looked_for = false;
  std::vector<ObjectSighting> sightings;
  int columns = 0;  // of probes
  int rows = 0;
  int step_px = 1;                            // of the full picture between two probes
  std::vector<std::uint16_t> depth_tenth_mm;  // row by row; 0 = none
  std::vector<bool> is_dynamic;
};

}  // namespace rds::mapper
