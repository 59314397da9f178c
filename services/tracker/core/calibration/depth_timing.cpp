// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/calibration/depth_timing.hpp"

#include <cstdlib>

namespace rds::tracker {
namespace {

constexpr std::int64_t kEveryNs = 100'000'000;

double offset_s(const image::RgbdFrame& frame) { return static_cast<double>(frame.depth_offset_ns) * 1e-9; }

}  // namespace

image::DepthImage DepthTiming::at_color_time(const image::RgbdFrame& frame, const Twist& velocity,
                                             const Executor& executor) {
  const double after_s = offset_s(frame) + delay_.delay_s();
  if (after_s == 0) return frame.depth;
  if (!motion_ || motion_->camera() != frame.camera) motion_.emplace(frame.camera);
  return motion_->moved(frame.depth, se3_exp(velocity * after_s), executor);
}

void DepthTiming::observe(const image::RgbdFrame& frame, const ImagePyramid& grey, const Twist& velocity) {
  if (!learns_delay_ || (observed_ns_ && std::abs(frame.stamp_ns - *observed_ns_) < kEveryNs)) return;
  observed_ns_ = frame.stamp_ns;
  delay_.observe(grey, frame.depth, frame.camera, velocity, offset_s(frame));
}

}  // namespace rds::tracker
