// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/geometry/camera_model.hpp"
#include "common/image/rgbd_frame.hpp"
#include "services/tracker/core/features/image_pyramid.hpp"
#include "services/tracker/core/motion/se3.hpp"

namespace rds::tracker {

/// How much later than their stamps say the depth pictures of a camera are taken, beside its colour pictures.
///
/// Where something ends in depth, the colour picture has an edge. While the camera turns, the edges in depth
/// lie on those in colour only if they are moved by the time between the two pictures. Of some delays it
/// sums up, picture by picture, how strong the edges are that the depth picture's lie on then, relative to
/// their mean over all delays. The strongest is the delay, if it is stronger than none at all by more than
/// chance. What moves in its own way, and depth that lies beside colour, say the same of all delays in the
/// long run.
class DepthDelay {
 public:
  /// @param velocity  of the camera, as MotionPrediction's. @param offset_s  from the colour picture's stamp
  /// to the depth picture's.
  void observe(const ImagePyramid& grey, const image::DepthImage& depth, const geometry::CameraModel& camera,
               const Twist& velocity, double offset_s);

  /// [s]; negative if depth is taken earlier; 0 until one is known.
  [[nodiscard]] double delay_s() const { return delay_s_; }

 private:
  static constexpr std::size_t kDelays = 11;
  using Curve = std::array<double, kDelays>;

  [[nodiscard]] static double at(std::size_t i);
  void add(const Curve& strength);
  [[nodiscard]] double strongest() const;

  int pictures_ = 0;
  Curve sum_{};         // of the edges' strength beyond that without a delay
  Curve squares_{};     // of the same
  double delay_s_ = 0;
};

}  // namespace rds::tracker
