// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "services/mapper/core/keyframe/voxel_key.hpp"

namespace rds::mapper {

/// Lowest and highest keys of voxels that come and go: how many have each coordinate.
class KeyBounds {
 public:
  void add(const octomap::OcTreeKey& key) {
    for (unsigned axis = 0; axis < 3; ++axis) axes_[axis].add(key[axis]);
  }
  /// One that was added.
  void remove(const octomap::OcTreeKey& key) {
    for (unsigned axis = 0; axis < 3; ++axis) axes_[axis].remove(key[axis]);
  }
  /// There must be a voxel.
  [[nodiscard]] std::array<std::uint16_t, 3> lowest() const {
    return {axes_[0].low, axes_[1].low, axes_[2].low};
  }
  [[nodiscard]] std::array<std::uint16_t, 3> highest() const {
    return {axes_[0].high, axes_[1].high, axes_[2].high};
  }

 private:
  struct Axis {
    void add(std::uint16_t at) {
      if (voxels++ == 0) low = high = at;
      low = at < low ? at : low;
      high = at > high ? at : high;
      ++count[at];
    }
    void remove(std::uint16_t at) {
      --count[at];
      if (--voxels == 0) return;
      while (count[low] == 0) ++low;
      while (count[high] == 0) --high;
    }
    std::vector<std::uint32_t> count = std::vector<std::uint32_t>(65536);
    std::uint64_t voxels = 0;
    std::uint16_t low = 0;
    std::uint16_t high = 0;
  };
  std::array<Axis, 3> axes_;
};

}  // namespace rds::mapper
