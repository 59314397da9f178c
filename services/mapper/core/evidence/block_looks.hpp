// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <memory_resource>
#include <vector>

#include "services/mapper/core/evidence/sightings.hpp"
#include "services/mapper/core/evidence/voxel_look.hpp"

namespace rds::mapper {

/// Looks of a block's voxels in which keyframes have seen a surface.
class BlockLooks {
 public:
  explicit BlockLooks(std::pmr::memory_resource* memory) : looks_(memory) {}

  void add(std::uint16_t cell, const SurfaceLook& look) { at(cell).add(look); }
  void add(std::uint16_t cell, const VoxelLook& look) { at(cell).add(look); }
  /// What was added before.
  void remove(std::uint16_t cell, const SurfaceLook& look) {
    if (find(cell) == nullptr) return;
    at(cell).remove(look);
    if (at(cell).empty()) erase(cell);
  }
  /// nullptr if there is none.
  [[nodiscard]] const VoxelLook* find(std::size_t cell) const {
    return place_ && (*place_)[cell] != 0 ? &looks_[(*place_)[cell] - 1U].look : nullptr;
  }

 private:
  struct Look {
    std::uint16_t cell;
    VoxelLook look;
  };
  VoxelLook& at(std::uint16_t cell) {
    if (!place_) place_ = std::allocate_shared<PerCell<std::uint16_t>>(looks_.get_allocator());
    auto& place = (*place_)[cell];
    if (place == 0) {
      looks_.push_back({cell, {}});
      place = static_cast<std::uint16_t>(looks_.size());
    }
    return looks_[place - 1U].look;
  }
  void erase(std::uint16_t cell) {
    const std::uint16_t place = std::exchange((*place_)[cell], std::uint16_t{0});
    if (place < looks_.size()) {  // the last one takes its place
      looks_[place - 1U] = std::move(looks_.back());
      (*place_)[looks_[place - 1U].cell] = place;
    }
    looks_.pop_back();
  }

  std::shared_ptr<PerCell<std::uint16_t>> place_;  // in looks_, from 1; 0: none
  std::pmr::vector<Look> looks_;
};

}  // namespace rds::mapper
