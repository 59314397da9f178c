// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory_resource>
#include <span>
#include <vector>

#include "services/mapper/core/evidence/block_mask.hpp"
#include "services/mapper/core/evidence/voxel_look.hpp"

namespace rds::mapper {

/// A connected surface of a keyframe's picture, from 1; 0: of none.
struct SurfacePart {
  std::uint16_t surface : 15;
  std::uint16_t is_labelled : 1;  // bears the label of a static object
};

/// What all keyframes together say of a surface of one of them.
enum class SurfaceVerdict : std::uint8_t {
  kUndecided,  // what is doubtful or unknown of it does not count, the rest does
  kConfirmed,  // all of it counts
  kTransient,  // nothing of it counts
};

/// What one keyframe says about the voxels of a block: those with each observation, no voxel with two.
struct BlockSight {
  BlockMask no_return;
  BlockMask passed;
  BlockMask unknown;
  BlockMask doubtful;
  BlockMask stable;        // Observation::kStatic
  BlockMask near_dynamic;  // beside its observation: something dynamic was within half a cube (kDynamicCubeM)

  [[nodiscard]] bool empty() const {
    return (no_return | passed | unknown | doubtful | stable | near_dynamic).empty();
  }
  [[nodiscard]] BlockMask surfaces() const { return unknown | doubtful | stable; }
  [[nodiscard]] BlockMask seen_static() const { return doubtful | stable; }
};

/// What of it counts for the occupancy.
struct BlockStep {
  BlockMask hit;
  BlockMask passed;
  BlockMask no_return;
  BlockMask seen_static;  // static or doubtful
  BlockMask near_dynamic;
};

/// What one keyframe, with one pose, says about space: its observations, packed in bit planes of which those
/// that are the same all over a block take no room; its surfaces, which stand or fall as a whole; and how
/// they look.
class KeyframeView {
 public:
  KeyframeView() = default;
  /// The same in another memory.
  KeyframeView(const KeyframeView& other, std::pmr::memory_resource* memory);

  /// Appends a block. @param key  of its lowest voxel; each at most once. @param parts  of which surfaces its
  /// static, doubtful and unknown voxels are, in order of their cells. @param looks  of the static and
  /// doubtful ones.
  void add(const octomap::OcTreeKey& key, const BlockSight& sight, std::span<const SurfacePart> parts,
           std::span<const SurfaceLook> looks);
  /// @param is_large  of each surface, from 0: whether it fills much of the picture.
  void set_surfaces(std::vector<bool> is_large);

  [[nodiscard]] std::size_t size() const { return blocks_.size(); }
  [[nodiscard]] octomap::OcTreeKey key(std::size_t block) const {
    const auto& key = blocks_[block].key;
    return {key[0], key[1], key[2]};
  }
  [[nodiscard]] BlockSight sight(std::size_t block) const;
  /// With surfaces by their verdicts.
  [[nodiscard]] BlockStep step(std::size_t block) const;
  /// Calls visit(cell, part) for the surfaces' voxels in a block. @param surfaces  of its sight().
  template <class Visit>
  void for_each_surface_voxel(std::size_t block, const BlockMask& surfaces, Visit visit) const {
    const SurfacePart* part = parts_.data() + blocks_[block].first_part;
    surfaces.for_each([&](std::size_t cell) { visit(cell, *part++); });
  }

  /// Calls visit(cell, look) for the static and doubtful voxels of a block.
  template <class Visit>
  void for_each_look(std::size_t block, Visit visit) const {
    if (!has_surfaces(block)) return;
    std::size_t look = blocks_[block].first_look;
    sight(block).seen_static().for_each([&](std::size_t cell) {
      SurfaceLook its_look = looks_[look_of_voxel_[look]];
      its_look.rgb = rgb_[look++];
      visit(static_cast<std::uint16_t>(cell), its_look);
    });
  }

  [[nodiscard]] bool has_surfaces(std::size_t block) const { return blocks_[block].parts > 0; }
  /// Whether it has surfaces, or something dynamic was there.
  [[nodiscard]] bool has_sightings(std::size_t block) const {
    return has_surfaces(block) || blocks_[block].planes[kNearPlane] != Plane::kZeros;
  }
  [[nodiscard]] const std::vector<bool>& is_large() const { return is_large_; }
  /// Of each surface, from 0.
  [[nodiscard]] const std::vector<SurfaceVerdict>& verdicts() const { return verdicts_; }
  void set_verdicts(std::vector<SurfaceVerdict> verdicts);

 private:
  static constexpr unsigned kPlanes = 4;  // three of the observation's number, and
  static constexpr unsigned kNearPlane = 3;
  enum class Plane : std::uint8_t { kZeros, kOnes, kStored };
  struct Block {
    std::array<std::uint16_t, 3> key;
    std::array<Plane, kPlanes> planes;
    std::uint16_t parts;
    std::uint32_t first_word;  // of the stored planes, eight words each
    std::uint32_t first_part;
    std::uint32_t first_look;
  };
  std::uint16_t index_of(SurfaceLook look);

  std::pmr::vector<Block> blocks_;
  std::pmr::vector<std::uint64_t> words_;
  std::pmr::vector<SurfacePart> parts_;
  std::pmr::vector<std::array<std::uint8_t, 3>> rgb_;  // of static and doubtful voxels
  std::pmr::vector<std::uint16_t> look_of_voxel_;      // and the rest of their look, in looks_
  std::vector<SurfaceLook> looks_;                // without colour, each once: few are different
  std::vector<bool> is_large_;
  std::vector<SurfaceVerdict> verdicts_;
  bool is_decided_ = false;  // some verdict is not kUndecided
};

}  // namespace rds::mapper
