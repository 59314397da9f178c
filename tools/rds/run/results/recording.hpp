// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/box.hpp"
#include "common/geometry/pose.hpp"

namespace rds::run {

/// What became of one frame, as the tracker told.
struct FrameRecord {
  std::int64_t stamp_ns = 0;
  std::string state;
  bool has_pose = false;
  bool is_in_submap = false;  // tracked, but its reference keyframe had no place in the map yet
  bool is_keyframe = false;
  std::uint32_t features = 0;
  std::uint32_t dynamic_features = 0;
  std::uint32_t inliers = 0;
  double extract_ms = 0;
  double predict_ms = 0;
  double track_ms = 0;
  double total_ms = 0;
  std::uint64_t reference_keyframe_id = 0;
  geometry::Pose map_from_camera = geometry::Pose::Identity();
  geometry::Pose reference_from_camera = geometry::Pose::Identity();
  std::uint64_t map_epoch = 0;
};

struct PredictionRecord {
  std::uint64_t id = 0;
  std::string label;
  geometry::Box2 box;
  geometry::Box3 volume;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  double age_s = 0;
};

struct DetectionRecord {
  std::string label;
  double score = 0;
  geometry::Box2 box;
  double depth_m = 0;
};

struct KeyframeRecord {
  std::int64_t stamp_ns = 0;
  geometry::Pose map_from_camera = geometry::Pose::Identity();
};

/// An earlier keyframe by which a loop was closed: the loop closer recognised it, and the tracker followed.
struct LoopRecord {
  std::int64_t earlier_ns = 0;
  geometry::Pose earlier_from_later = geometry::Pose::Identity();
};

/// Everything a run heard on the bus that its files need; ordered by stamp or id, whatever the order of
/// arrival.
struct Recording {
  std::map<std::int64_t, FrameRecord> frames;
  std::map<std::int64_t, std::vector<PredictionRecord>> predictions;
  std::map<std::int64_t, std::vector<DetectionRecord>> detections;
  std::map<std::uint64_t, KeyframeRecord> keyframes;  // of the last map epoch
  std::uint64_t keyframes_in_map = 0;                 // of these, that the map holds at the end
  std::uint64_t map_epoch = 0;                        // that one
  std::vector<double> map_delays_s;  // from a keyframe to the map that has it, while it lasted
  std::uint64_t keyframes_revision = 0;
  std::uint32_t loops_closed = 0;
  std::map<std::int64_t, std::vector<LoopRecord>> loops;  // by stamp of the later keyframe
  std::uint64_t frames_dropped = 0;
};

}  // namespace rds::run
