// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>


namespace rds::test {

/// What became of the camera's path and of the map.
struct Figures {
  double ate_live_m = 0;
  double ate_final_m = 0;
  double recall = 0;  // of the voxels of the undisturbed run's map
};

/// The undisturbed map stands for the truth: a camera that moves as little as in these seconds tells too little
/// of where the truth's frame lies.
/// @param out  results of a trial. @param undisturbed  those it is compared with, which may be the same.
/// @throws std::runtime_error with one sentence if they cannot be scored.
Figures figures_of(const std::filesystem::path& recording, const std::filesystem::path& out,
                   const std::filesystem::path& undisturbed);

}  // namespace rds::test
