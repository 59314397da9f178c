// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/config/config_reader.hpp"
#include "common/store/maps_folder.hpp"
#include "common/topics/topics.hpp"
#include "services/tracker/core/config/tracker_config.hpp"
#include "services/tracker/core/prediction/prediction_config.hpp"
#include "services/tracker/odometry/frames_config.hpp"
#include "services/tracker/robot/inputs_config.hpp"

namespace rds::tracker {

/// Where the camera's pictures come from; names without the leading rt/.
struct CameraTopics {
  std::string color = topics::kColor.name;
  std::string camera_info = topics::kCameraInfo.name;
  std::string depth = topics::kDepth.name;
  std::string depth_info;          // of the depth camera; empty: camera_info beside `depth`
  std::string transport = "auto";  // raw or compressed; auto: compressed where nobody publishes raw pictures
  bool best_effort = false;        // ask no driver for reliability; otherwise those that offer it
  double pairing_tolerance_s = 0.02;

  bool operator==(const CameraTopics&) const = default;
};

/// When answers of other threads and processes take effect.
struct LockstepConfig {
  bool enabled = false;  // at the frames that KeyframeAnswers names; otherwise as soon as they have arrived
  std::uint64_t detection_latency_frames = 2;  // boxes of keyframe k take effect at frame k + this
  double timeout_s = 10;                       // then a frame goes on without the answer

  bool operator==(const LockstepConfig&) const = default;
};

struct TrackerServiceConfig {
  int nice = 0;           // of the process
  int mapping_nice = 10;  // of local mapping's thread: tracking has the processor first
  CameraTopics camera;
  FramesConfig frames;
  InputsConfig inputs;
  LockstepConfig lockstep;
  bool dynamics = true;          // boxes are used (and in lockstep waited for)
  bool loop_closer = true;       // in lockstep: its answers are waited for
  std::string poses_file;        // TUM trajectory that the camera follows; empty: poses are estimated
  double poses_max_gap_s = 0.1;  // between neighbours that a pose is interpolated from
  std::string map_file;          // saved map that it starts from; empty: none
  store::MapsConfig maps;
  double resume_s =
      10;  // of usable pictures; a camera that does not find itself in its checkpoint's map begins another
  TrackerConfig tracker;
  prediction::PredictionConfig prediction;

  bool operator==(const TrackerServiceConfig&) const = default;
};

void read(config::ConfigReader& reader, TrackerServiceConfig& config);

}  // namespace rds::tracker
