// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "common/geometry/pose.hpp"

namespace rds::loop_closer {

/// The features of a keyframe that can verify a loop: static, with depth. Row i of both is feature i.
struct KeyframeView {
  cv::Mat descriptors;                  // N×32 CV_8U
  std::vector<Eigen::Vector3d> points;  // N, camera frame [m], z > 0
};

struct VerifiedLoop {
  geometry::Pose candidate_from_query = geometry::Pose::Identity();
  int inliers = 0;
  double inlier_share = 0;  // of the features that both keyframes should see
};

/// Whether two keyframes show the same place, and how they stand to each other.
///
/// Descriptor matches → RANSAC (≥ 20 inliers) → matches guided by that transform → refinement (≥ 50 inliers,
/// spread over 15 cm, a fifth of what both should see).
/// Source: Mur-Artal & Tardós 2017 (counts). Deviation: 3-D to 3-D in rays and inverse depth, share and
/// extent.
[[nodiscard]] std::optional<VerifiedLoop> verify_loop(const KeyframeView& query,
                                                      const KeyframeView& candidate);

}  // namespace rds::loop_closer
