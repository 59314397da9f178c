// SPDX-License-Identifier: Apache-2.0
#include "common/topics/camera_presets.hpp"

#include <algorithm>
#include <vector>

namespace rds::topics {

CameraPreset read_camera_preset(config::ConfigReader& reader, const std::string& key) {
  std::vector<std::string> names;
  for (const CameraPreset& preset : kCameraPresets) names.emplace_back(preset.name);
  std::string name = names.front();
  reader.choice(key, name, names);
  return *std::ranges::find(kCameraPresets, name, [](const CameraPreset& p) { return std::string(p.name); });
}

void read_topic(config::ConfigReader& reader, const std::string& key, const char* preset,
                std::string& target) {
  std::string given;
  reader.value(key, given);
  target = given.empty() ? preset : given;
}

}  // namespace rds::topics
