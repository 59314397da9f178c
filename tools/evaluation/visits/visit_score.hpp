// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

namespace rds::evaluation {

/// A recording of a floor, and the centres of the voxels [m] that held a surface of it that day.
struct Visit {
  std::filesystem::path recording;
  std::vector<Eigen::Vector3d> surfaces;
};

struct VisitScoreInput {
  Visit visit;
  std::vector<Visit> earlier;        // of the same floor, in the same frame; what has moved since is scored
  std::vector<Eigen::Vector3d> map;  // centres of its occupied voxels, in that frame
  double voxel_m = 0;
  int every = 5;  // depth pictures between two that are looked at
};

/// A map after a visit against the floor as it stands that day, as far as the visit's depth pictures (three
/// of them at least) show it.
///
/// Where surfaces of an earlier day and of this day differ, parts that hang together are pieces that were
/// carried away or put there. Shares are NaN where nothing is asked.
struct VisitScore {
  double recall = 0;     // of the true voxels that show: share with a map voxel in the 3×3×3 around
  double precision = 0;  // of the map's voxels that show or are seen through: share within 2 of a true one
  std::size_t moved_from = 0;       // pieces that showed on an earlier day, and whose place is seen through
  std::size_t moved_from_free = 0;  // of them: at most a tenth of that is still in the map
  std::size_t moved_to = 0;         // pieces that show where nothing was on an earlier day
  std::size_t moved_to_mapped = 0;  // of them: nine tenths of what shows are in the map
};

/// @return or one sentence that names what cannot be read.
tl::expected<VisitScore, std::string> score_visit(const VisitScoreInput& input);

}  // namespace rds::evaluation
