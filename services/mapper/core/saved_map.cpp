// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/saved_map.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "common/map_file/checksum.hpp"
#include "common/map_file/geometry_bytes.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "services/mapper/core/octree/voxel_walk.hpp"

namespace rds::mapper {
namespace {

using map_file::ByteReader;
using map_file::ByteWriter;
using Looks = std::unordered_map<std::uint64_t, VoxelLook>;  // by key
using octomap::ColorOcTree;
using octomap::OcTreeKey;

constexpr double kSameResolution = 1e-9;  // m
constexpr std::size_t kLookBytes = 8 + 3 * 4 + 2 * 4;

void put_looks(ByteWriter& writer, const Map& map) {
  std::vector<std::pair<std::uint64_t, const VoxelLook*>> looks;
  for_each_voxel(map.octree.tree(), [&](const OcTreeKey& key, const octomap::ColorOcTreeNode& node) {
    const EvidenceBlock* block = map.octree.tree().isNodeOccupied(node) ? map.evidence.block(key) : nullptr;
    const VoxelLook* look = block != nullptr ? block->look(cell_of(key)) : nullptr;
    if (look != nullptr) looks.emplace_back(packed(key), look);
  });
  writer.put_count(looks.size());
  for (const auto& [key, look] : looks) {
    writer.put(key);
    look->put(writer);
  }
}

Looks get_looks(ByteReader& reader, std::size_t labels) {
  Looks looks;
  const std::size_t count = reader.get_count(kLookBytes);
  for (std::size_t i = 0; i < count && reader.ok(); ++i) {
    const auto key = reader.get<std::uint64_t>();
    if (!looks.emplace(key, VoxelLook::get(reader, labels)).second) reader.refuse("a voxel twice");
  }
  return looks;
}

/// What is wrong with a saved resolution; empty if it is the expected one.
std::string other_resolution(double saved_m, double expected_m) {
  if (std::abs(saved_m - expected_m) <= kSameResolution) return {};
  return fmt::format("voxels of {} m, expected {} m", saved_m, expected_m);
}

VoxelLook look_of(const octomap::ColorOcTreeNode& node) {
  const auto color = node.getColor();
  VoxelLook look;
  look.add(SurfaceLook{{color.r, color.g, color.b}, 0, false, {}});
  return look;
}

std::shared_ptr<const FinalMap> voxels_of(const ColorOcTree& tree, const Looks& looks) {
  std::map<std::uint64_t, FinalBlock> blocks;
  for_each_voxel(tree, [&](const OcTreeKey& key, const octomap::ColorOcTreeNode& node) {
    const double rounded = std::round(kPerNat * double{node.getLogOdds()});
    const auto log_odds = static_cast<LogOdds>(std::clamp(rounded, double{kLowest}, double{kHighest}));
    const auto look = looks.find(packed(key));
    blocks[packed(block_key(key))].add(cell_of(key), log_odds,
                                       look != looks.end() ? look->second : look_of(node));
  });
  auto voxels = std::make_shared<FinalMap>();
  while (!blocks.empty()) {
    auto block = blocks.extract(blocks.begin());
    voxels->blocks.emplace(block.key(), std::make_shared<const FinalBlock>(std::move(block.mapped())));
  }
  return voxels;
}

}  // namespace

map_file::Bytes to_bytes(const SemanticMap& map, const Eigen::Vector3d& up) {
  const auto nodes = to_bytes(map.tree());
  ByteWriter writer;
  map.labels.put(writer);
  map_file::put(writer, up);
  writer.put(map.tree().getResolution());
  writer.put_count(nodes.size());
  writer.put_bytes(nodes);
  put_looks(writer, *map.content);
  map.content->objects.put(writer);
  return writer.take();
}

tl::expected<double, std::string> voxel_size_of(std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  (void)LabelTable::get(reader);
  map_file::get_vector(reader);
  const auto voxel_m = reader.get<double>();
  if (reader.ok() && (voxel_m < OctreeConfig::kMinResolutionM || voxel_m > OctreeConfig::kMaxResolutionM))
    reader.refuse(fmt::format("voxels of {} m", voxel_m));
  if (!reader.ok()) return tl::unexpected(reader.finish().error());
  return voxel_m;
}

ReadMap saved_map_from(std::span<const std::uint8_t> bytes, const MapperConfig& config) {
  ByteReader reader(bytes);
  SavedMap saved{nullptr, ObjectDatabase(config.objects), LabelTable::get(reader),
                 map_file::get_vector(reader), map_file::checksum_of(bytes)};
  if (reader.ok() && std::abs(saved.up->norm() - 1) > 1e-6)
    reader.refuse("an upward direction that is no unit vector");
  const auto resolution = reader.get<double>();
  if (auto fault = other_resolution(resolution, config.octree.resolution_m); reader.ok() && !fault.empty())
    reader.refuse(std::move(fault));
  const auto nodes = reader.get_bytes(reader.get_count(1));
  if (!reader.ok()) return tl::unexpected(reader.finish().error());
  const auto tree = tree_from_bytes(nodes, config.octree.resolution_m);
  if (!tree) return tl::unexpected(tree.error());
  const Looks looks = get_looks(reader, saved.labels.names().size());
  saved.objects->get(reader);
  if (auto read = reader.finish(); !read) return tl::unexpected(read.error());
  saved.voxels = voxels_of(**tree, looks);
  return saved;
}

ReadMap saved_map_from(ColorOcTree&& tree, const MapperConfig& config) {
  if (auto fault = other_resolution(tree.getResolution(), config.octree.resolution_m); !fault.empty())
    return tl::unexpected(std::move(fault));
  return SavedMap{
      voxels_of(tree, {}), ObjectDatabase(config.objects), {}, {}, map_file::checksum_of(to_bytes(tree))};
}

}  // namespace rds::mapper
