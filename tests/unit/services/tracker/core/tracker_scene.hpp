// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <gmock/gmock.h>

#include "services/tracker/core/tracker.hpp"
#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker::test {

inline constexpr std::int64_t kFrameNs = 66'000'000;

/// Quick enough for a test of many frames.
inline TrackerConfig small_config() {
  TrackerConfig config;
  config.extraction.features = 500;
  config.extraction.levels = 4;
  config.map_frame.level = false;  // truth is told in the first camera's frame
  return config;
}

/// The wall with strips that stand out: of a place that lies in one plane no lost camera believes anything.
inline image::RgbdFrame picture_of_strips(const Pose& map_from_camera, std::int64_t stamp_ns,
                                          const geometry::CameraModel& camera = small_camera()) {
  return picture_of_wall(map_from_camera, stamp_ns, camera, 0.6);
}

/// Where the camera is at a frame: it is carried along the wall and turns.
inline Pose truth(int frame) {
  return pose(0.015 * frame, 0.004 * frame, 0.01 * frame, 0.004 * frame);
}

inline FrameResult step(Tracker& tracker, int frame,
                        std::span<const segmentation::ObjectRegion> movable = {}) {
  return tracker.track(picture_of_strips(truth(frame), frame * kFrameNs), movable);
}

/// Of a frame of a tracker that started at frame 0.
inline double error_m(const FrameResult& result, int frame) {
  const Pose expected = truth(0).inverse() * truth(frame);
  return (expected.translation() - result.map_from_camera.translation()).norm();
}

}  // namespace rds::tracker::test
