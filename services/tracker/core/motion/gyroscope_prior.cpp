// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/motion/gyroscope_prior.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace rds::tracker {
namespace {

constexpr double kNsPerSecond = 1e9;
constexpr double kWindowS = 0.25;
constexpr std::size_t kWindows = 4;   // that trust is made of
constexpr double kChi2 = 16.27;       // of one window, three degrees of freedom, 0.999
constexpr double kChi2OfAll = 32.91;  // of all of them
constexpr double kTurnedRad = 0.05;   // by either: a window that says something, as vision is wrong by less
constexpr double kVisionRad = 0.004;  // standard deviation at each end
constexpr double kOfTurn = 0.03;      // of the turn: scale, mounting, and clocks that differ by a few ms
constexpr double kBiasSigmaPerSecond = 5e-4;  // rad/s, grows with the root: temperature

}  // namespace

std::optional<Eigen::Quaterniond> GyroscopePrior::expect(std::int64_t from_ns, std::int64_t to_ns) {
  frame_.reset();
  if (!gyroscope_) return std::nullopt;
  const auto told = gyroscope_(from_ns, to_ns);
  if (!told) {
    begin_window();
    return std::nullopt;
  }
  const double s = static_cast<double>(to_ns - from_ns) / kNsPerSecond;
  frame_ = Turn{*told, Eigen::Quaterniond::Identity(), s};
  bias_variance_ += kBiasSigmaPerSecond * kBiasSigmaPerSecond * s;
  if (!is_trusted()) return std::nullopt;
  ++told_;
  return *told * turn_by(-s * bias_);
}

void GyroscopePrior::observe(const Eigen::Quaterniond& by_vision) {
  const auto frame = std::exchange(frame_, std::nullopt);
  if (!frame) return;
  window_.by_gyroscope = window_.by_gyroscope * frame->by_gyroscope;
  window_.by_vision = window_.by_vision * by_vision;
  window_.duration_s += frame->duration_s;
  if (window_.duration_s < kWindowS) return;
  learn(window_);
  window_ = {};
}

void GyroscopePrior::begin_window() {
  frame_.reset();
  window_ = {};
}

void GyroscopePrior::learn(const Turn& window) {
  const double s = window.duration_s;
  const Eigen::Quaterniond unbiased = window.by_gyroscope * turn_by(-s * bias_);
  const Eigen::Vector3d innovation = rotation_of(unbiased.conjugate() * window.by_vision);
  const double angle = std::max(rotation_of(unbiased).norm(), rotation_of(window.by_vision).norm());
  const double of_turn = kOfTurn * angle;
  const double variance = bias_variance_ * s * s + 2 * kVisionRad * kVisionRad + of_turn * of_turn;
  const double squared = innovation.squaredNorm() / variance;
  const bool has_passed = squared <= kChi2;
  refused_ += has_passed ? 0 : 1;
  if (angle > kTurnedRad || !has_passed) innovations_.push_back(squared);
  if (innovations_.size() > kWindows) innovations_.pop_front();
  if (innovations_.size() == kWindows && !are_consistent()) {  // it has another bias by now, or none
    bias_.setZero();
    bias_variance_ = kInitialBiasSigma * kInitialBiasSigma;
    innovations_.clear();
    return;
  }
  if (!has_passed) return;
  const double gain = bias_variance_ * s / variance;
  bias_ -= gain * innovation;
  bias_variance_ *= 1 - gain * s;
}

bool GyroscopePrior::are_consistent() const {
  return std::accumulate(innovations_.begin(), innovations_.end(), 0.0) <= kChi2OfAll;
}

bool GyroscopePrior::is_trusted() const {
  return innovations_.size() == kWindows && innovations_.back() <= kChi2;
}

}  // namespace rds::tracker
