// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace rds::tracker::prediction {

/// Linear assignment with the smallest sum of costs.
///
/// @param cost  N×M, finite.
/// @return for each of the N rows its column, nullopt for the rows left over when N > M. O(min² · max).
/// @throws std::invalid_argument if a cost is not finite.
/// Source: shortest augmenting paths with dual variables, Jonker & Volgenant 1987 (the "Hungarian algorithm"
/// of the paper's §IV-B). Deviation: without their column-reduction start.
std::vector<std::optional<Eigen::Index>> assign(const Eigen::MatrixXd& cost);

}  // namespace rds::tracker::prediction
