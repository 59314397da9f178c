// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/keyframe/keyframe_record.hpp"

namespace rds::mapper {

/// An object as a keyframe, with its pose, shows it.
struct ObjectInPlace {
  std::uint16_t label = 0;
  float score = 0;
  bool cut_by_border = false;
  geometry::Box3 box;  // map frame; per axis, 2nd to 98th percentile of its points; not finite without any
};

/// What the object database needs of a keyframe: its sightings, and a coarse depth picture that tells whether
/// what is not detected is hidden, gone or overlooked. Kept for each keyframe, a few kB: after a correction
/// the database is made again of all of them.
struct ObjectView {
  static constexpr int kProbeStep = 8;  // every so many sampled pixels one probe

  /// @param record  classified, its objects labelled.
  static ObjectView of(const KeyframeRecord& record);

  std::uint64_t keyframe_id = 0;
  std::int64_t stamp_ns = 0;
  geometry::Pose map_from_camera = geometry::Pose::Identity();
  geometry::CameraModel camera;
  bool looked_for = false;
  std::vector<ObjectInPlace> sightings;
  int columns = 0;  // of probes
  int rows = 0;
  int step_px = 1;                            // of the full picture between two probes
  std::vector<std::uint16_t> depth_tenth_mm;  // row by row; 0 = none
  std::vector<bool> is_dynamic;
};

}  // namespace rds::mapper
