// SPDX-License-Identifier: Apache-2.0
#include "services/transformer/transformer_service_config.hpp"

#include "common/topics/camera_presets.hpp"

namespace rds::transformer {

void read(config::ConfigReader& reader, TransformerServiceConfig& config) {
  reader.value("nice", config.nice, 0, 19);
  const topics::CameraPreset preset = topics::read_camera_preset(reader, "camera_preset");
  topics::read_topic(reader, "camera_info_topic", preset.camera_info, config.camera_info_topic);
  read(reader, config.transformer);
}

}  // namespace rds::transformer
