// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>

#include "services/tracker/core/motion/gyroscope_buffer.hpp"

namespace rds::tracker {

/// The camera's turn between two times by a gyroscope, earlier_from_later, in the camera's frame; nullopt
/// where it says nothing.
using Gyroscope = std::function<std::optional<Eigen::Quaterniond>(std::int64_t from_ns, std::int64_t to_ns)>;

/// What a gyroscope says of the camera's turn, as far as vision has found it right.
///
/// Over windows of a quarter of a second its turn G, without the bias b that is known, is compared with
/// vision's V: the innovation r = log((G exp(−b Δ))ᵀ V) has the covariance S = P Δ² + N, with P of the bias,
/// and N of vision at both ends and of a scale and a mounting that are not exact. A window passes if rᵀ S⁻¹ r
/// ≤ χ²₃(.999); then a Kalman update takes b from it. The gyroscope is trusted while the last window in which
/// something turned has passed, and the last four together; so one that is mounted otherwise than tf says,
/// has another clock, or is stuck, is not.
class GyroscopePrior {
 public:
  /// @param gyroscope  empty: nothing is ever told.
  explicit GyroscopePrior(Gyroscope gyroscope) : gyroscope_(std::move(gyroscope)) {}

  /// A picture was taken at `to_ns`, the last one with a pose at `from_ns`.
  /// @return the camera's turn between the two; nullopt where it is not known or trusted.
  std::optional<Eigen::Quaterniond> expect(std::int64_t from_ns, std::int64_t to_ns);
  /// Vision is sure of that turn.
  void observe(const Eigen::Quaterniond& by_vision);
  /// The next pose has nothing to do with those before.
  void begin_window();

  [[nodiscard]] bool is_trusted() const;
  /// In the camera's frame [rad/s].
  [[nodiscard]] const Eigen::Vector3d& bias() const { return bias_; }
  /// Windows that have not passed.
  [[nodiscard]] std::uint64_t refused() const { return refused_; }
  /// Frames whose turn it has told.
  [[nodiscard]] std::uint64_t told() const { return told_; }

 private:
  struct Turn {
    Eigen::Quaterniond by_gyroscope = Eigen::Quaterniond::Identity();
    Eigen::Quaterniond by_vision = Eigen::Quaterniond::Identity();
    double duration_s = 0;
  };
  void learn(const Turn& window);
  [[nodiscard]] bool are_consistent() const;

  Gyroscope gyroscope_;
  std::optional<Turn> frame_;  // since the last pose
  Turn window_;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  double bias_variance_ = kInitialBiasSigma * kInitialBiasSigma;  // of each axis
  std::deque<double> innovations_;  // squared, normalised, of the last windows in which something turned
  std::uint64_t refused_ = 0;
  std::uint64_t told_ = 0;

  static constexpr double kInitialBiasSigma = 0.02;  // rad/s, of a consumer's chip: 1°/s
};

}  // namespace rds::tracker
