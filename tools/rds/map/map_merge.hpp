// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <tl/expected.hpp>

#include "common/geometry/trajectory.hpp"
#include "common/map_file/saved_map.hpp"
#include "services/mapper/core/evidence/later_map.hpp"
#include "services/tracker/core/merging/map_merging.hpp"

namespace rds::tools {

/// What two saved maps were merged by, and what the result holds.
struct MergeReport {
  std::string earlier;  // as the user named them
  std::string later;
  tracker::MapJoint joint;
  std::size_t keyframes = 0;  // of the merged map, with those that were culled
  std::size_t points = 0;
  mapper::VoxelChanges voxels;
  std::size_t objects = 0;
  std::size_t common_objects = 0;
  std::size_t gone_objects = 0;
  std::vector<std::string> without_loop_closer;  // maps that have no part of it
};

/// A saved map made of two.
struct MapMerge {
  map_file::Sections sections;                   // of map.rds
  std::map<std::string, map_file::Bytes> files;  // for others, to lie beside it
  std::vector<geometry::StampedPose> keyframes;  // map_from_camera, by stamp
  MergeReport report;
};

/// Merges two saved maps: map.rds, or folders that hold one. The later one was made at a later time or by
/// another robot; what it saw gone is gone. Neither is changed.
/// @return or one sentence: a file that cannot be read, a part that is missing, maps that do not fit together
/// or have nothing in common.
tl::expected<MapMerge, std::string> merge_saved_maps(const std::filesystem::path& earlier,
                                                     const std::filesystem::path& later);

/// Writes a new folder with map.rds, the files for others, and keyframes.txt: all of it, or none.
/// @return or one sentence; also where the folder is there already.
tl::expected<void, std::string> write_map(const MapMerge& merge, const std::filesystem::path& folder);

/// The report in sentences, one a line.
std::string describe(const MergeReport& report);
nlohmann::ordered_json to_json(const MergeReport& report);

}  // namespace rds::tools
