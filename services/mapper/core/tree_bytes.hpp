// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <octomap/ColorOcTree.h>
#include <tl/expected.hpp>

namespace rds::mapper {

/// The payload of octomap_msgs/Octomap (id ColorOcTree, binary = false): what ColorOcTree::writeData writes.
std::vector<std::uint8_t> to_bytes(const octomap::ColorOcTree& tree);

/// Reads such a payload after checking it node by node, so that no byte sequence can do harm: depth, length,
/// finite values.
///
/// @param resolution_m  of the voxels.
/// @return the tree, every leaf at the finest level; or one sentence saying what is wrong.
tl::expected<std::unique_ptr<octomap::ColorOcTree>, std::string> tree_from_bytes(
    std::span<const std::uint8_t> bytes, double resolution_m);

}  // namespace rds::mapper
