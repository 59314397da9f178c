// SPDX-License-Identifier: Apache-2.0
#include "common/topics/camera_presets.hpp"

#include <gmock/gmock.h>

#include "common/topics/topics.hpp"

namespace rds::topics {
namespace {

using ::testing::HasSubstr;

TEST(CameraPresets, BeginWithTheNamesOfThisProject) {
  config::ConfigReader reader;
  const CameraPreset preset = read_camera_preset(reader, "preset");
  EXPECT_STREQ(preset.color, kColor.name);
  EXPECT_STREQ(preset.camera_info, kCameraInfo.name);
  EXPECT_STREQ(preset.depth, kDepth.name);
}

TEST(CameraPresets, AreAllKnownByTheirNames) {
  for (const CameraPreset& expected : kCameraPresets) {
    config::ConfigReader reader(YAML::Load(std::string("{preset: ") + expected.name + "}"), "x.yaml");
    EXPECT_STREQ(read_camera_preset(reader, "preset").depth, expected.depth);
    EXPECT_NO_THROW(reader.finish());
  }
}

TEST(CameraPresets, AreListedWhereANameIsNone) {
  config::ConfigReader reader(YAML::Load("{preset: kinect}"), "x.yaml");
  read_camera_preset(reader, "preset");
  try {
    reader.finish();
    FAIL() << "no violation found";
  } catch (const config::ConfigError& e) {
    EXPECT_THAT(
        e.what(),
        HasSubstr("preset: kinect, expected one of: rds, realsense, azure_kinect, orbbec, xtion, kinect_v1"));
  }
}

TEST(CameraPresets, GiveWayToATopicThatIsSet) {
  config::ConfigReader reader(YAML::Load("{color: mine, depth: ''}"), "x.yaml");
  std::string color;
  std::string depth;
  read_topic(reader, "color", "preset/color", color);
  read_topic(reader, "depth", "preset/depth", depth);
  EXPECT_EQ(color, "mine");
  EXPECT_EQ(depth, "preset/depth");
}

geometry::DepthNoise noise_by(const std::string& yaml) {
  config::ConfigReader reader(YAML::Load(yaml), "x.yaml");
  const CameraPreset preset = read_camera_preset(reader, "preset");
  const geometry::DepthNoise noise = read_depth_noise(reader, "depth_noise", preset);
  EXPECT_NO_THROW(reader.finish());
  return noise;
}

TEST(CameraPresets, SayHowWellTheirCameraMeasures) {
  for (const CameraPreset& preset : kCameraPresets)
    EXPECT_EQ(noise_by(std::string("{preset: ") + preset.name + "}").name, preset.depth_noise);
  EXPECT_EQ(noise_by("{}"), geometry::kDepthNoises.front());
  EXPECT_EQ(noise_by("{preset: orbbec, depth_noise: ''}").name, "orbbec");
  EXPECT_EQ(noise_by("{preset: orbbec, depth_noise: realsense}").name, "realsense");
}

TEST(CameraPresets, ListNoisesWhereANameIsNone) {
  config::ConfigReader reader(YAML::Load("{depth_noise: kinect}"), "x.yaml");
  const geometry::DepthNoise noise = read_depth_noise(reader, "depth_noise", kCameraPresets[1]);
  EXPECT_EQ(noise.name, kCameraPresets[1].depth_noise);
  try {
    reader.finish();
    FAIL() << "no violation found";
  } catch (const config::ConfigError& e) {
    EXPECT_THAT(e.what(), HasSubstr("depth_noise: kinect, expected one of: kinect_v1, xtion, realsense, "
                                    "azure_kinect, orbbec, ideal"));
  }
}

}  // namespace
}  // namespace rds::topics
