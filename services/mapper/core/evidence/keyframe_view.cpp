// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/keyframe_view.hpp"

#include <algorithm>

namespace rds::mapper {

KeyframeView::KeyframeView(const KeyframeView& other, std::pmr::memory_resource* memory)
    : blocks_(other.blocks_, memory),
      words_(other.words_, memory),
      parts_(other.parts_, memory),
      rgb_(other.rgb_, memory),
      look_of_voxel_(other.look_of_voxel_, memory),
      looks_(other.looks_),
      is_large_(other.is_large_),
      verdicts_(other.verdicts_),
      is_decided_(other.is_decided_) {}

void KeyframeView::add(const octomap::OcTreeKey& key, const BlockSight& sight,
                       std::span<const SurfacePart> parts, std::span<const SurfaceLook> looks) {
  Block block{{key[0], key[1], key[2]},
              {},
              static_cast<std::uint16_t>(parts.size()),
              static_cast<std::uint32_t>(words_.size()),
              static_cast<std::uint32_t>(parts_.size()),
              static_cast<std::uint32_t>(rgb_.size())};
  parts_.insert(parts_.end(), parts.begin(), parts.end());
  for (const SurfaceLook& look : looks) {
    rgb_.push_back(look.rgb);
    look_of_voxel_.push_back(index_of(look));
  }
  const std::array<BlockMask, kPlanes> planes{sight.no_return | sight.unknown | sight.stable,
                                              sight.passed | sight.unknown, sight.doubtful | sight.stable,
                                              sight.near_dynamic};
  for (unsigned bit = 0; bit < kPlanes; ++bit) {
    const BlockMask& plane = planes[bit];
    if (plane.empty()) {
      block.planes[bit] = Plane::kZeros;
    } else if (plane == BlockMask::all()) {
      block.planes[bit] = Plane::kOnes;
    } else {
      block.planes[bit] = Plane::kStored;
      for (std::size_t i = 0; i < BlockMask::kWords; ++i) words_.push_back(plane.word(i));
    }
  }
  blocks_.push_back(block);
}

/// In looks_. Neighbours mostly have the same one.
std::uint16_t KeyframeView::index_of(SurfaceLook look) {
  look.rgb = {};
  if (!look_of_voxel_.empty() && looks_[look_of_voxel_.back()] == look) return look_of_voxel_.back();
  const auto found = std::ranges::find(looks_, look);
  const auto index = static_cast<std::uint16_t>(found - looks_.begin());
  if (found == looks_.end()) looks_.push_back(look);
  return index;
}

BlockSight KeyframeView::sight(std::size_t at) const {
  const Block& block = blocks_[at];
  std::array<BlockMask, kPlanes> planes;
  std::size_t word = block.first_word;
  for (unsigned bit = 0; bit < kPlanes; ++bit) {
    if (block.planes[bit] == Plane::kOnes) planes[bit] = BlockMask::all();
    if (block.planes[bit] != Plane::kStored) continue;
    for (std::size_t i = 0; i < BlockMask::kWords; ++i) planes[bit].word(i) = words_[word + i];
    word += BlockMask::kWords;
  }
  const auto& [ones, twos, fours, near_dynamic] = planes;
  return {ones & ~(twos | fours), twos & ~ones, ones & twos, fours & ~ones, fours & ones, near_dynamic};
}

BlockStep KeyframeView::step(std::size_t block) const {
  const BlockSight sight = this->sight(block);
  BlockStep step{sight.stable, sight.passed, sight.no_return, sight.seen_static(), sight.near_dynamic};
  if (!is_decided_ || !has_surfaces(block)) return step;
  for_each_surface_voxel(block, sight.surfaces(), [&](std::size_t cell, SurfacePart part) {
    const SurfaceVerdict verdict = verdicts_[part.surface];
    if (verdict == SurfaceVerdict::kConfirmed) step.hit.insert(cell);
    if (verdict == SurfaceVerdict::kTransient) step.hit.erase(cell);
  });
  return step;
}

void KeyframeView::set_surfaces(std::vector<bool> is_large) {
  set_verdicts(std::vector(is_large.size(), SurfaceVerdict::kUndecided));
  is_large_ = std::move(is_large);
}

void KeyframeView::set_verdicts(std::vector<SurfaceVerdict> verdicts) {
  verdicts_ = std::move(verdicts);
  is_decided_ = std::ranges::any_of(
      verdicts_, [](SurfaceVerdict verdict) { return verdict != SurfaceVerdict::kUndecided; });
}

}  // namespace rds::mapper
