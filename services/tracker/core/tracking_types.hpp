// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "services/tracker/core/level/up_direction.hpp"
#include "services/tracker/core/map/submaps.hpp"
#include "services/tracker/core/mapping/keyframe_data.hpp"
#include "services/tracker/core/removal/movable_mask.hpp"

namespace rds::tracker {

/// Values equal rds_msgs/TrackingState's.
enum class State : std::uint8_t {
  kNotInitialized = 0,
  kTracking = 1,
  kWeak = 2,
  kLost = 3,
  kRelocalised = 4
};

/// True for the states in which a frame has a pose.
constexpr bool has_pose(State state) {
  return state == State::kTracking || state == State::kWeak || state == State::kRelocalised;
}

/// Features with depth that the first keyframe needs.
inline constexpr unsigned kMinFeaturesToStart = 150;

struct StageTimes {
  std::int64_t extract_us = 0;
  std::int64_t track_us = 0;
};

/// What became of a feature, for pictures.
struct KeypointVerdict {
  enum class Use : std::uint8_t { kUnused = 0, kUsed = 1, kDynamic = 2 };
  Eigen::Vector2f image_px = Eigen::Vector2f::Zero();
  Use use = Use::kUnused;
};

struct FrameResult {
  State state = State::kNotInitialized;
  Pose map_from_camera = Pose::Identity();  // identity unless has_pose(state)
  Eigen::Matrix<double, 6, 6> information =
      Eigen::Matrix<double, 6, 6>::Zero();  // OptimizedPose::information
  Eigen::Matrix<double, 6, 6> map_covariance =
      Eigen::Matrix<double, 6, 6>::Zero();  // of the map that the camera sees, against its origin (MapDrift)
  std::optional<Eigen::Matrix<double, 6, 6>>
      carried_covariance;  // of a pose that odometry has carried on, in place of its information
  std::uint64_t reference_keyframe_id = 0;
  Pose reference_from_camera = Pose::Identity();
  unsigned features = 0;          // extracted
  unsigned dynamic_features = 0;  // of these on movable objects
  unsigned inliers = 0;           // map points that support the pose
  StageTimes times;
  SubmapId submap = Submaps::kMap;        // that the pose and the keyframe are in, instead of the map
  bool begins_submap = false;             // it is the first frame of that
  std::optional<UpDirection> up;          // of the first frame of a map, if its surfaces were asked
  MovableMask movable;                    // whose features were dropped
  std::optional<KeyframeData> keyframe;   // if the frame became one
  std::vector<KeypointVerdict> verdicts;  // one per feature
};

}  // namespace rds::tracker
