// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/map_file/byte_reader.hpp"
#include "common/map_file/byte_writer.hpp"

namespace rds::mapper {

/// What one keyframe says of how a surface voxel looks.
struct SurfaceLook {
  std::array<std::uint8_t, 3> rgb{};
  std::uint16_t label = 0;                // of an object; 0: none
  bool looked_for = false;                // whether a detector has seen the keyframe
  std::array<std::uint16_t, 4> beside{};  // without a label: those of objects found around it; 0: none

  bool operator==(const SurfaceLook&) const = default;
};

/// Colour and label of a voxel: sums over keyframes, so that a keyframe can be taken out again.
class VoxelLook {
 public:
  void add(const SurfaceLook& look) { count(look, 1); }
  /// What was added before.
  void remove(const SurfaceLook& look) { count(look, -1); }
  void add(const VoxelLook& other);
  /// The same with the labels of another table. @param index_of  each label's index there, by its index here.
  [[nodiscard]] VoxelLook relabelled(std::span<const std::uint16_t> index_of) const;

  [[nodiscard]] bool empty() const { return keyframes_ == 0; }
  [[nodiscard]] std::array<std::uint8_t, 3> color() const;
  /// The label with most votes, of equal ones the lower index. 0 if it has fewer than a quarter of the votes:
  /// those for any label, and those of keyframes that found its object beside the voxel; or if too many found
  /// nothing.
  [[nodiscard]] std::uint16_t label() const;

  void put(map_file::ByteWriter& writer) const;
  /// @param labels  of the label table. Refuses what put() cannot have written.
  static VoxelLook get(map_file::ByteReader& reader, std::size_t labels);

 private:
  struct Votes {
    std::uint16_t label = 0;
    std::int32_t count = 0;
    std::int32_t against = 0;  // by keyframes that found the object beside the voxel
  };
  void count(const SurfaceLook& look, int by);
  void vote(const Votes& votes, int by);

  std::array<std::int32_t, 3> rgb_sum_{};
  std::int32_t keyframes_ = 0;
  std::int32_t silent_ = 0;   // keyframes that looked for objects and found none there
  std::vector<Votes> votes_;  // by label
};

}  // namespace rds::mapper
