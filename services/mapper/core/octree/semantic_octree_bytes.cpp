// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "services/mapper/core/octree/semantic_octree.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"

namespace rds::mapper {
namespace {

using map_file::ByteReader;
using map_file::ByteWriter;

constexpr std::size_t kVoxelBytes = 8 + 12 + 2 + 2 + 3 * 4;
constexpr std::uint64_t kLastKey = 0xFFFF'FFFF'FFFF;
constexpr double kSameResolution = 1e-9;  // m

/// What is wrong with a saved resolution; empty if it is the expected one.
std::string other_resolution(double saved_m, double expected_m) {
  if (std::abs(saved_m - expected_m) <= kSameResolution) return {};
  return fmt::format("voxels of {} m, expected {} m", saved_m, expected_m);
}

}  // namespace

tl::expected<void, std::string> SemanticOctree::start_from(octomap::ColorOcTree&& tree) {
  if (auto fault = other_resolution(tree.getResolution(), config_.resolution_m); !fault.empty())
    return tl::unexpected(std::move(fault));
  tree_.adopt(std::move(tree));
  return {};
}

void SemanticOctree::put(ByteWriter& writer) const {
  const auto nodes = to_bytes(tree_);
  writer.put(tree_.getResolution());
  writer.put_count(nodes.size());
  writer.put_bytes(nodes);
  std::vector<std::uint64_t> keys;
  keys.reserve(voxels_.size());
  for (const auto& [key, voxel] : voxels_) keys.push_back(key);
  std::ranges::sort(keys);
  writer.put_count(keys.size());
  for (const std::uint64_t key : keys) {
    writer.put(key);
    voxels_.at(key).put(writer);
  }
}

void SemanticOctree::get(ByteReader& reader, std::size_t labels) {
  const auto resolution = reader.get<double>();
  if (auto fault = other_resolution(resolution, config_.resolution_m); reader.ok() && !fault.empty())
    reader.refuse(std::move(fault));
  const auto nodes = reader.get_bytes(reader.get_count(1));
  if (!reader.ok()) return;
  auto tree = tree_from_bytes(nodes, config_.resolution_m);
  if (!tree) return reader.refuse(tree.error());
  tree_.adopt(std::move(**tree));
  voxels_.clear();
  const std::size_t voxels = reader.get_count(kVoxelBytes);
  for (std::size_t i = 0; i < voxels && reader.ok(); ++i) {
    const auto key = reader.get<std::uint64_t>();
    if (key > kLastKey || !voxels_.emplace(key, SemanticVoxel::get(reader, labels)).second)
      reader.refuse("a voxel twice, or outside of any map");
  }
}

}  // namespace rds::mapper
