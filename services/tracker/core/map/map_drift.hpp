// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <unordered_map>

#include "services/tracker/core/map/slam_map.hpp"
#include "services/tracker/core/motion/se3.hpp"

namespace rds::tracker {

/// How uncertain the parts of a map are against its origin, which is its first keyframe.
///
/// A keyframe k errs by what the points that it was found by err by, and by its own error. A point errs by
/// what the keyframe errs by that brought it into the map:
///
///     Σ_k = M_k + C_k,   M_k = Σ_j w_j A_kj Σ_j A_kjᵀ,   Σ_0 = 0
///
/// with w_j the share of k's points that j brought, A_kj the adjoint that puts a motion of camera j into
/// camera k, and C_k the covariance of k's pose in the points. The errors of one map depend on each other;
/// the mean of covariances bounds the covariance of a mean for every such dependence. So where a camera comes
/// back to what it knows, Σ falls. Bundle adjustment and loops make errors smaller than that. Keyframes of a
/// map that was saved, or of another run, are taken as exact.
class MapDrift {
 public:
  /// A keyframe of the map. @param covariance  Σ_k, of a motion of the camera in its own frame.
  void add(KeyframeId keyframe, const Matrix6& covariance) { covariances_[keyframe] = covariance; }
  /// M of a camera that sees these points (kNoId: none), of a motion in its own frame; zero without points.
  [[nodiscard]] Matrix6 under(const SlamMap& map, std::span<const PointId> points,
                              const Pose& map_from_camera) const;
  void forget() { covariances_.clear(); }

 private:
  std::unordered_map<KeyframeId, Matrix6> covariances_;  // looked up only: their order means nothing
};

}  // namespace rds::tracker
