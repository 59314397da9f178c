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
/// finite values, and no more than kFreeVoxels + kVoxelsPerByte × bytes voxels (at most kMaxVoxels), whatever
/// pruned leaves stand for; a block of 8×8×8 counts as a whole, as it takes memory.
///
/// @param resolution_m  of the voxels.
/// @return the tree, every leaf at the finest level; or one sentence saying what is wrong.
tl::expected<std::unique_ptr<octomap::ColorOcTree>, std::string> tree_from_bytes(
    std::span<const std::uint8_t> bytes, double resolution_m);

/// The payload of octomap_msgs/Octomap with binary = true, and of .bt files: occupied, free or unknown, 2
/// bits a node; what ColorOcTree::writeBinaryData writes of the pruned tree.
std::vector<std::uint8_t> to_binary_bytes(const octomap::ColorOcTree& tree);

/// Reads such a payload, with the same care. Log-odds are ±kBinaryLogOdds, colours white.
tl::expected<std::unique_ptr<octomap::ColorOcTree>, std::string> tree_from_binary_bytes(
    std::span<const std::uint8_t> bytes, double resolution_m);

inline constexpr std::uint64_t kMaxVoxels = 100'000'000;
inline constexpr std::uint64_t kFreeVoxels = 300'000;
inline constexpr std::uint64_t kVoxelsPerByte = 64;         // tree_from_bytes()
inline constexpr std::uint64_t kVoxelsPerBinaryByte = 512;  // tree_from_binary_bytes()
inline constexpr std::uint64_t kBytesPerVoxel = 64;         // of memory, at most
inline constexpr float kBinaryLogOdds = 2.0F;

}  // namespace rds::mapper
