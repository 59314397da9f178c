// SPDX-License-Identifier: Apache-2.0
#include "common/topics/camera_presets.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/ranges.h>

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

geometry::DepthNoise read_depth_noise(config::ConfigReader& reader, const std::string& key,
                                      const CameraPreset& preset) {
  std::string name;
  reader.value(key, name);
  const auto of_preset = geometry::depth_noise(preset.depth_noise).value();
  if (name.empty()) return of_preset;
  if (const auto named = geometry::depth_noise(name)) return *named;
  std::vector<std::string_view> names;
  for (const geometry::DepthNoise& noise : geometry::kDepthNoises) names.push_back(noise.name);
  reader.violation(key, name, fmt::format("expected one of: {}", fmt::join(names, ", ")));
  return of_preset;
}

}  // namespace rds::topics
