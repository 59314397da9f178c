// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "tools/evaluation/trajectory_evaluation.hpp"

namespace rds::evaluation {

struct MapScoreInput {
  std::filesystem::path dataset;     // with groundtruth.txt; masks/ where people walk
  std::filesystem::path background;  // the same sequence without people
  std::filesystem::path out;         // map.ot, keyframes.txt
  int every = 5;                     // frames between two depth pictures that are looked at
  std::filesystem::path seen_by = {};  // results whose keyframes tell what can be in the map; empty: out's
  Alignment align = Alignment::kPositions;
};

struct ResidueScore {
  std::size_t people_voxels = 0;  // voxels people's surfaces passed through, away from static surfaces
  double residue = 0;             // share of them the map holds occupied
  double residue_map = 0;         // those as a share of the map's occupied voxels
};

struct MapScore {
  std::size_t nodes = 0;
  std::size_t occupied = 0;  // voxels
  double resolution_m = 0;
  double static_recall =
      0;  // of the true static voxels seen in a keyframe: share with a map voxel in the 3×3×3 around
  double precision = 0;                 // of the map's voxels: share within 2 voxels of a true static surface
  std::optional<ResidueScore> residue;  // if the dataset has masks
};

/// Compares a map with the surfaces that the depth pictures really show, from true poses.
///
/// The map goes to the truth's frame with the rigid transform that aligns keyframes.txt with groundtruth.txt.
/// @return or one sentence: an input that cannot be read, keyframes that do not fit the truth.
tl::expected<MapScore, std::string> score_map(const MapScoreInput& input);

}  // namespace rds::evaluation
