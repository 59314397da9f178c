// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "services/tracker/core/motion/se3.hpp"

namespace rds::tracker {

/// Speed of a body by a Kalman filter on its poses.
///
/// State: a pose T and the body's twist ξ in its own frame. Between poses ξ stays, but for white
/// acceleration: T ← T exp(ξ Δ), with the covariance's transition F = [Ad(exp(−ξΔ)), Δ·1; 0, 1] and the noise
/// Q = q ⊗ [Δ³/3, Δ²/2; Δ²/2, Δ]. A pose T_z tells the innovation log(T⁻¹ T_z). Source: Bar-Shalom, Li,
/// Kirubarajan 2001, §6.2.2, with errors on SE(3).
class TwistFilter {
 public:
  /// The next pose. @param noise  covariance of what is new in its error since the pose before, of a motion
  /// of the body in its own frame. A pose that is not later than the last one, or later by more than a
  /// second, begins anew.
  void step(std::int64_t stamp_ns, const geometry::Pose& parent_from_body, const Matrix6& noise);
  void reset() { state_.reset(); }
  [[nodiscard]] Twist twist() const { return state_ ? state_->twist : Twist::Zero(); }
  [[nodiscard]] Matrix6 covariance() const;

 private:
  using Matrix12 = Eigen::Matrix<double, 12, 12>;
  struct State {
    std::int64_t stamp_ns;
    geometry::Pose pose;
    Twist twist;
    Matrix12 covariance;  // of pose, then twist
  };
  static void predict(double s, State& state);
  static void update(const geometry::Pose& measured, const Matrix6& noise, State& state);

  std::optional<State> state_;
};

}  // namespace rds::tracker
