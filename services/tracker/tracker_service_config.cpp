// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_service_config.hpp"

#include "common/topics/camera_presets.hpp"

namespace rds::tracker {
namespace {

void read(config::ConfigReader& reader, CameraTopics& camera, geometry::DepthNoise& noise) {
  const topics::CameraPreset preset = topics::read_camera_preset(reader, "preset");
  topics::read_topic(reader, "color", preset.color, camera.color);
  topics::read_topic(reader, "camera_info", preset.camera_info, camera.camera_info);
  topics::read_topic(reader, "depth", preset.depth, camera.depth);
  reader.value("depth_info", camera.depth_info);
  noise = topics::read_depth_noise(reader, "depth_noise", preset);
  reader.choice("transport", camera.transport, {"auto", "raw", "compressed"});
  reader.value("best_effort", camera.best_effort);
  reader.value("pairing_tolerance_s", camera.pairing_tolerance_s, 0.0, 0.5, "s");
}

void read(config::ConfigReader& reader, FramesConfig& config) {
  reader.value("base", config.base);
  reader.value("publish_tf", config.publish_tf);
}

void read(config::ConfigReader& reader, InputsConfig& config) {
  reader.value("odometry", config.odometry);
  reader.value("odometry_frame", config.odometry_frame);
  if (!config.odometry.empty() && !config.odometry_frame.empty())
    reader.violation("odometry_frame", config.odometry_frame, "expected no odometry beside it");
  reader.value("imu", config.imu);
  reader.value("initial_pose", config.initial_pose);
}

void read(config::ConfigReader& reader, LockstepConfig& config) {
  reader.value("lockstep", config.enabled);
  reader.value("detection_latency_frames", config.detection_latency_frames, std::uint64_t{1},
               std::uint64_t{100}, "frames");
  reader.value("lockstep_timeout_s", config.timeout_s, 0.1, 600.0, "s");
}

}  // namespace

void read(config::ConfigReader& reader, TrackerServiceConfig& config) {
  reader.value("nice", config.nice, 0, 19);
  reader.value("mapping_nice", config.mapping_nice, 0, 19);
  read(reader.section("camera"), config.camera, config.tracker.depth.noise);
  read(reader.section("frames"), config.frames);
  read(reader.section("inputs"), config.inputs);
  read(reader, config.lockstep);
  reader.value("dynamics", config.dynamics);
  reader.value("loop_closer", config.loop_closer);
  reader.value("poses_file", config.poses_file);
  reader.value("poses_max_gap_s", config.poses_max_gap_s, 0.0, 3600.0, "s");
  reader.value("map_file", config.map_file);
  if (!config.poses_file.empty() && !config.map_file.empty())
    reader.violation("poses_file", config.poses_file,
                     "expected no map_file beside it, given poses know no saved map");
  read(reader, config.maps);
  reader.value("resume_s", config.resume_s, 0.0, 1e6, "s");
  read(reader, config.tracker);
  if (config.tracker.localize_only && config.map_file.empty())
    reader.violation("localize_only", "true", "expected a map_file to localise in");
  read(reader.section("prediction"), config.prediction);
  labels::read(reader, config.prediction.labels);
  config.tracker.keep_all_poses = config.lockstep.enabled;  // a run ends
  if (!config.dynamics) config.tracker.removal.method = "off";
}

}  // namespace rds::tracker
