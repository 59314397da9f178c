// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/geometry/pose.hpp"

namespace rds::loop_closer {

enum class EdgeKind { kOdometry, kCovisible, kLoop };

/// A measured relative pose of two keyframes, by their place in the list of poses.
struct PoseGraphEdge {
  std::size_t from = 0;
  std::size_t to = 0;
  geometry::Pose from_from_to = geometry::Pose::Identity();  // pose of `to` in the frame of `from`
  EdgeKind kind = EdgeKind::kOdometry;
};

/// How far the poses are from what an edge measured.
struct EdgeResidual {
  double translation_m = 0;
  double rotation_rad = 0;
};
[[nodiscard]] EdgeResidual residual_of(const PoseGraphEdge& edge,
                                       std::span<const geometry::Pose> map_from_camera);

/// Moves the poses so that they agree best with the edges; the first `held` stay where they are.
///
/// Residual of an edge: translation and rotation vector of measured⁻¹ · estimated, over the edge's sigmas;
/// Huber for loop edges. One thread, so that the result is the same on every run.
/// @return false if the solver failed; the poses are then unchanged.
/// @param held  at least 1. @throws std::invalid_argument if an edge names a pose that is not there.
bool optimize_pose_graph(std::vector<geometry::Pose>& map_from_camera, std::span<const PoseGraphEdge> edges,
                         std::size_t held = 1);

}  // namespace rds::loop_closer
