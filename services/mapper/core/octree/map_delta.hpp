// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <octomap/ColorOcTree.h>

namespace rds::mapper {

/// What one step changed in the map. Applied to a tree of `base_revision` it gives the tree of `revision`.
/// Row i of each array is voxel i; keys are OctoMap keys at the finest level.
struct MapDelta {
  std::uint64_t map_epoch = 0;
  std::uint64_t map_id = 0;  // of the map within the epoch; who sends the delta sets it
  std::uint64_t base_revision = 0;
  std::uint64_t revision = 0;
  std::uint64_t keyframe_id = 0;
  std::int64_t stamp_ns = 0;
  double resolution = 0;                    // [m]
  std::vector<std::uint16_t> keys;          // 3N: x y z
  std::vector<float> log_odds;              // N, new values
  std::vector<std::uint16_t> labels;        // N, index into the label table; 0 = no object
  std::vector<std::uint8_t> colors;         // 3N: r g b
  std::vector<std::uint16_t> deleted_keys;  // 3M

  /// Appends a voxel with its new values.
  void add(const octomap::OcTreeKey& key, const octomap::ColorOcTreeNode& voxel, std::uint16_t label) {
    keys.insert(keys.end(), {key[0], key[1], key[2]});
    log_odds.push_back(voxel.getLogOdds());
    labels.push_back(label);
    const auto color = voxel.getColor();
    colors.insert(colors.end(), {color.r, color.g, color.b});
  }

  /// True when there is nothing to tell: the revision did not change.
  [[nodiscard]] bool is_noop() const { return revision == base_revision; }
};

}  // namespace rds::mapper
