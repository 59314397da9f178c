// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/mapper_service_config.hpp"

#include "common/topics/camera_presets.hpp"

namespace rds::mapper {

void read(config::ConfigReader& reader, MapperServiceConfig& config) {
  reader.value("nice", config.nice, 0, 19);
  const topics::CameraPreset preset = topics::read_camera_preset(reader, "camera_preset");
  config.mapper.sampling.depth_noise = topics::read_depth_noise(reader, "depth_noise", preset);
  reader.value("lockstep", config.lockstep);
  reader.value("expect_boxes", config.expect_boxes);
  reader.value("boxes_timeout_s", config.boxes_timeout_s, 0.0, 60.0, "s");
  reader.value("full_map_every", config.full_map_every, 1, 100000, "keyframes");
  reader.value("map_file", config.map_file);
  reader.value("localize_only", config.localize_only);
  read(reader, config.maps);
  read(reader, config.mapper);
}

}  // namespace rds::mapper
