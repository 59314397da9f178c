// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "common/geometry/pose_change.hpp"
#include "services/tracker/core/map/map_bytes.hpp"

namespace rds::tracker {

/// What two maps were merged by.
struct MapJoint {
  std::size_t searched = 0;  // keyframes of the later map that were looked for in the earlier one
  std::size_t found = 0;     // … and found
  std::size_t agreeing = 0;  // of these, those that lie where they were found, by the merged map
  std::size_t inliers = 0;   // points by which those were found
  std::size_t fused = 0;     // points of both that are one
  Pose earlier_from_later = Pose::Identity();  // where the two meet
  double residual_m = 0;    // median difference of where keyframes were found and where they lie
  double residual_rad = 0;  // likewise
};

/// One map of two, in the earlier one's frame.
struct MergedMap {
  SavedMap saved;
  KeyframeId first_of_later = 0;            // ids of the later map's keyframes count on from here
  std::vector<geometry::PoseChange> moved;  // its keyframes: from the later map's frame to the merged one
  MapJoint joint;
};

/// Merges two saved maps of places that have something in common.
///
/// All keyframes of the later map are looked for in the earlier one. Where the most of them agree on how the
/// maps lie to each other, three at least, and what both measured does not contradict it, the later map goes
/// to its place as a submap does. Then, by turns, points that both see are fused where a sighting agrees with
/// the map as it stands, and the later map's keyframes and the points are adjusted: so a later map that has
/// drifted is joined at its far end, too. The earlier map's keyframes stay.
///
/// @param depth  of the sensor.
/// @return or why they cannot be merged, in words that can follow "B: ": another camera, nothing or not
/// enough in common.
/// Source: Campos et al. 2021 (ORB-SLAM3), §VI-B. Deviation: all sightings are there at once, so the largest
/// set that agrees is taken, not the first.
tl::expected<MergedMap, std::string> merge_maps(const SavedMap& earlier, const SavedMap& later);

}  // namespace rds::tracker
