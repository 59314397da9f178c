// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/mapper/core/evidence/observation.hpp"

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

/// What one keyframe, with one pose, says about space: its observations, packed in bit planes of which those
/// that are the same all over a block take no room; and its surfaces, which stand or fall as a whole.
class KeyframeView {
 public:
  /// Appends a block. @param key  of its lowest voxel; each at most once. @param parts  of which surfaces its
  /// static, doubtful and unknown voxels are, in order of their cells.
  void add(const octomap::OcTreeKey& key, const BlockObservations& observations,
           const std::vector<SurfacePart>& parts);
  /// @param is_large  of each surface, from 0: whether it fills much of the picture.
  void set_surfaces(std::vector<bool> is_large);

  [[nodiscard]] std::size_t size() const { return blocks_.size(); }
  [[nodiscard]] octomap::OcTreeKey key(std::size_t block) const {
    const auto& key = blocks_[block].key;
    return {key[0], key[1], key[2]};
  }
  /// As they were added.
  void unpack(std::size_t block, BlockObservations& observations) const;
  /// With surfaces by their verdicts: none is doubtful or unknown.
  void unpack_decided(std::size_t block, BlockObservations& observations) const;
  /// Calls visit(cell, observation, part) for the surfaces' voxels in a block.
  template <class Visit>
  void for_each_surface_voxel(std::size_t block, Visit visit) const;

  [[nodiscard]] bool has_surfaces(std::size_t block) const { return blocks_[block].parts > 0; }
  /// Whether something dynamic was there, or a ray without return passed.
  [[nodiscard]] bool is_equivocal(std::size_t block) const { return blocks_[block].is_equivocal; }
  [[nodiscard]] const std::vector<bool>& is_large() const { return is_large_; }
  /// Of each surface, from 0.
  [[nodiscard]] const std::vector<SurfaceVerdict>& verdicts() const { return verdicts_; }
  void set_verdicts(std::vector<SurfaceVerdict> verdicts) { verdicts_ = std::move(verdicts); }

 private:
  enum class Plane : std::uint8_t { kZeros, kOnes, kStored };
  struct Block {
    std::array<std::uint16_t, 3> key;
    std::array<Plane, kBitsOfObservation> planes;
    bool is_equivocal;
    std::uint16_t parts;
    std::uint32_t first_word;  // of the stored planes, eight words each
    std::uint32_t first_part;
  };
  std::vector<Block> blocks_;
  std::vector<std::uint64_t> words_;
  std::vector<SurfacePart> parts_;
  std::vector<bool> is_large_;
  std::vector<SurfaceVerdict> verdicts_;
};

template <class Visit>
void KeyframeView::for_each_surface_voxel(std::size_t block, Visit visit) const {
  if (blocks_[block].parts == 0) return;
  BlockObservations observations;
  unpack(block, observations);
  const SurfacePart* part = &parts_[blocks_[block].first_part];
  for (std::size_t cell = 0; cell < kBlockCells; ++cell)
    if (const auto observation = observation_in(observations[cell]); observation >= Observation::kUnknown)
      visit(cell, observation, *part++);
}

}  // namespace rds::mapper
