// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tests/faults/recordings.hpp"

namespace rds::test {

/// What became of the camera's path and of the map.
struct Figures {
  double ate_live_m = 0;
  double ate_final_m = 0;
  double recall = 0;  // of the static surfaces that keyframes of `seen_by` have seen
};

/// @param out  results of a trial. @param seen_by  those of the undisturbed one, which may be the same.
/// @throws std::runtime_error with one sentence if they cannot be scored.
Figures figures_of(const RecordingPair& recording, const std::filesystem::path& out,
                   const std::filesystem::path& seen_by);

}  // namespace rds::test
