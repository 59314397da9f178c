// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include <tl/expected.hpp>

#include "services/mapper/core/semantic_map.hpp"

namespace rds::mapper {

/// A saved map, as map epochs begin with it. It stays as it is; keyframes come on top.
struct SavedMap {
  std::shared_ptr<const FinalMap> voxels;  // nullptr: none
  std::optional<ObjectDatabase> objects;
  LabelTable labels;
  std::optional<Eigen::Vector3d> up;  // in the map, if it is known
  std::uint64_t checksum = 0;         // of what it was read from
};

/// Or what does not fit, in one sentence.
using ReadMap = tl::expected<SavedMap, std::string>;

/// From a tree without labels and objects, fully expanded.
ReadMap saved_map_from(octomap::ColorOcTree&& tree, const MapperConfig& config);
/// From what to_bytes() gave: with labels, objects and the direction of gravity.
ReadMap saved_map_from(std::span<const std::uint8_t> bytes, const MapperConfig& config);

/// The size of a saved map's voxels [m]. @return or what is wrong with the bytes.
tl::expected<double, std::string> voxel_size_of(std::span<const std::uint8_t> bytes);

/// The map with all that further keyframes need of it; not the keyframes.
/// @param up  unit vector against gravity in the map frame.
map_file::Bytes to_bytes(const SemanticMap& map, const Eigen::Vector3d& up);

}  // namespace rds::mapper
