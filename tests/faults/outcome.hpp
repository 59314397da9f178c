// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tests/faults/recordings.hpp"

namespace rds::test {

/// What became of the camera's path and of the map.
struct Figures {
  double ate_live_m = 0;
  double ate_final_m = 0;
  double recall = 0;  // of the static surfaces that the undisturbed run's keyframes have seen; of its map's
                      // voxels where nobody walks
};

/// A camera that only turns tells too little of where truth's frame lies to compare its map with truth: there
/// the undisturbed map stands for it.
/// @param out  results of a trial. @param undisturbed  those it is compared with, which may be the same.
/// @throws std::runtime_error with one sentence if they cannot be scored.
Figures figures_of(const RecordingPair& recording, const std::filesystem::path& out,
                   const std::filesystem::path& undisturbed);

}  // namespace rds::test
