// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/map_snapshot.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "services/mapper/core/octree/label_table.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "services/mapper/core/octree/voxel_walk.hpp"

namespace rds::mapper {
namespace {

using octomap::ColorOcTree;
using octomap::ColorOcTreeNode;
using octomap::OcTreeKey;

Rgb color_of(const ColorOcTreeNode& node) {
  const auto color = node.getColor();
  return {color.r, color.g, color.b};
}

/// Calls visit(key, node, label) for every occupied voxel.
template <class Visit>
void for_each_occupied(const ColorOcTree& tree, const MapSnapshot& snapshot, const Visit& visit) {
  std::size_t row = 0;
  for_each_voxel(tree, [&](const OcTreeKey& key, const ColorOcTreeNode& node) {
    if (tree.isNodeOccupied(node)) visit(key, node, snapshot.labels_of_occupied.at(row++));
  });
}

template <class Value>
void append(std::vector<std::uint8_t>& bytes, Value value) {
  static_assert(std::endian::native == std::endian::little);
  const auto raw = std::bit_cast<std::array<std::uint8_t, sizeof(Value)>>(value);
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

}  // namespace

MapSnapshot take_snapshot(const SemanticMapper& mapper) {
  const ColorOcTree& tree = mapper.map().tree();
  MapSnapshot snapshot;
  snapshot.resolution = tree.getResolution();
  snapshot.nodes = to_bytes(tree);
  for_each_voxel(tree, [&](const OcTreeKey& key, const ColorOcTreeNode& node) {
    if (tree.isNodeOccupied(node)) snapshot.labels_of_occupied.push_back(mapper.map().label(key));
  });
  snapshot.labels = mapper.map().labels.names();
  snapshot.up = mapper.up_in_map();
  snapshot.objects = mapper.map().objects(snapshot.up);
  return snapshot;
}

LabelRows labels_not_shown_by_colors(const ColorOcTree& tree, const MapSnapshot& snapshot) {
  const ColorLabels told(snapshot.labels);
  LabelRows rows;
  for_each_occupied(tree, snapshot,
                    [&](const OcTreeKey& key, const ColorOcTreeNode& node, std::uint16_t label) {
                      if (told.label_of(color_of(node)) == label) return;
                      rows.keys.insert(rows.keys.end(), {key[0], key[1], key[2]});
                      rows.values.push_back(label);
                    });
  return rows;
}

MapPoints points_of(const ColorOcTree& tree, const MapSnapshot& snapshot) {
  MapPoints points;
  points.count = static_cast<std::uint32_t>(snapshot.labels_of_occupied.size());
  points.rows.reserve(std::size_t{points.count} * MapPoints::kRowBytes);
  for_each_occupied(
      tree, snapshot, [&](const OcTreeKey& key, const ColorOcTreeNode& node, std::uint16_t label) {
        for (unsigned axis = 0; axis < 3; ++axis)
          append(points.rows, static_cast<float>(tree.keyToCoord(key[axis])));
        const Rgb color = color_of(node);
        append(points.rows, static_cast<std::uint32_t>(color[0] << 16 | color[1] << 8 | color[2]));
        append(points.rows, std::uint32_t{label});
      });
  return points;
}

MapDelta whole_map(const ColorOcTree& tree, const MapSnapshot& snapshot, const MapDelta& head) {
  MapDelta delta = head;
  delta.resolution = snapshot.resolution;
  std::size_t row = 0;
  for_each_voxel(tree, [&](const OcTreeKey& key, const ColorOcTreeNode& node) {
    const bool occupied = tree.isNodeOccupied(node);
    delta.add(key, node, occupied ? snapshot.labels_of_occupied.at(row++) : std::uint16_t{0});
  });
  return delta;
}

MapExtent extent_of(const SemanticOctree& octree) {
  const ColorOcTree& tree = octree.tree();
  MapExtent extent;
  if (tree.getRoot() == nullptr) return extent;
  extent.occupied = octree.occupied();
  const auto low = octree.bounds().lowest();
  const auto high = octree.bounds().highest();
  const double half = tree.getResolution() / 2;
  for (unsigned axis = 0; axis < 3; ++axis) {
    extent.min[axis] = tree.keyToCoord(low[axis]) - half;
    extent.max[axis] = tree.keyToCoord(high[axis]) + half;
  }
  return extent;
}

}  // namespace rds::mapper
