// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/octree/label_table.hpp"
#include "services/mapper/core/octree/scan.hpp"

namespace rds::mapper {

/// Colour and label of an occupied voxel, from all keyframes that have seen it.
class SemanticVoxel {
 public:
  void see_color(const SurfaceVoxel& surface);
  /// One vote per keyframe that looked for objects; label 0 votes against all.
  void vote(std::uint16_t label);
  /// The label with most votes if it has the needed share, else 0; ties go to the lower index.
  [[nodiscard]] std::uint16_t label(double needed_share) const;
  [[nodiscard]] Rgb color() const;
  [[nodiscard]] int times_seen() const { return times_seen_; }

  void put(map_file::ByteWriter& writer) const;
  /// @param labels  of the label table. Refuses colours and labels that cannot be.
  static SemanticVoxel get(map_file::ByteReader& reader, std::size_t labels);

 private:
  struct Votes {
    std::uint16_t label = 0;
    std::uint16_t count = 0;
  };
  std::array<float, 3> mean_rgb_{};
  std::uint16_t times_seen_ = 0;
  std::uint16_t votes_cast_ = 0;
  std::array<Votes, 3> votes_{};
};

}  // namespace rds::mapper
