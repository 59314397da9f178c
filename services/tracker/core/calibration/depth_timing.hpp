// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "common/image/depth_motion.hpp"
#include "services/tracker/core/calibration/depth_delay.hpp"
#include "services/tracker/core/features/executor.hpp"

namespace rds::tracker {

/// Depth as it was when the colour picture was taken: a camera takes the two at different times, and moves
/// between them.
class DepthTiming {
 public:
  /// @param learns_delay  else depth is taken when its stamps say.
  explicit DepthTiming(bool learns_delay) : learns_delay_(learns_delay) {}

  /// The depth picture at the colour picture's time. @param velocity  as MotionPrediction's.
  [[nodiscard]] image::DepthImage at_color_time(const image::RgbdFrame& frame, const Twist& velocity,
                                                const Executor& executor);
  /// Learns from a frame's pictures as they were taken, and the velocity that was found; at most ten times a
  /// second.
  void observe(const image::RgbdFrame& frame, const ImagePyramid& grey, const Twist& velocity);

  [[nodiscard]] double delay_s() const { return delay_.delay_s(); }

 private:
  bool learns_delay_;
  DepthDelay delay_;
  std::optional<image::DepthMotion> motion_;  // of the camera that the pictures are of
  std::optional<std::int64_t> observed_ns_;
};

}  // namespace rds::tracker
