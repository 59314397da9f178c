// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_service_config.hpp"

#include <gmock/gmock.h>

namespace rds::tracker {
namespace {

TEST(TrackerServiceConfig, LocalizingNeedsAMap) {
  config::ConfigReader reader(YAML::Load("localize_only: true"), "tracker.yaml");
  TrackerServiceConfig config;
  read(reader, config);
  EXPECT_THROW(reader.finish(), config::ConfigError);
}

TEST(TrackerServiceConfig, GivenPosesKnowNoSavedMap) {
  config::ConfigReader reader(YAML::Load("{poses_file: poses.txt, map_file: map.rds}"), "tracker.yaml");
  TrackerServiceConfig config;
  read(reader, config);
  EXPECT_THROW(reader.finish(), config::ConfigError);
}

TEST(TrackerServiceConfig, NamesEveryViolation) {
  config::ConfigReader reader(
      YAML::Load("{lockstep_timeout_s: 0, camera: {pairing_tolerance_s: 3, colour: x}}"), "tracker.yaml");
  TrackerServiceConfig config;
  read(reader, config);
  try {
    reader.finish();
    FAIL() << "no violation found";
  } catch (const config::ConfigError& e) {
    EXPECT_THAT(e.what(), ::testing::AllOf(::testing::HasSubstr("lockstep_timeout_s: 0, expected"),
                                           ::testing::HasSubstr("camera.pairing_tolerance_s: 3, expected"),
                                           ::testing::HasSubstr("camera.colour: unknown key")));
  }
}

TEST(TrackerServiceConfig, ReadsOdometryFromOneSource) {
  config::ConfigReader reader(YAML::Load("{inputs: {odometry: odom, odometry_frame: odom}}"), "tracker.yaml");
  TrackerServiceConfig config;
  read(reader, config);
  EXPECT_THROW(reader.finish(), config::ConfigError);
  InputsConfig inputs;
  EXPECT_FALSE(inputs.reads_odometry());
  inputs.odometry_frame = "odom";
  EXPECT_TRUE(inputs.reads_odometry());
}

TEST(TrackerServiceConfig, TakesTopicsOfThePresetUnlessTheyAreSet) {
  config::ConfigReader reader(YAML::Load("{camera: {preset: xtion, depth: mine/depth}}"), "tracker.yaml");
  TrackerServiceConfig config;
  read(reader, config);
  EXPECT_NO_THROW(reader.finish());
  EXPECT_EQ(config.camera.color, "camera/rgb/image_raw");
  EXPECT_EQ(config.camera.camera_info, "camera/rgb/camera_info");
  EXPECT_EQ(config.camera.depth, "mine/depth");
}

TEST(TrackerServiceConfig, TakesTheDepthNoiseOfThePresetUnlessItIsSet) {
  const auto noise_by = [](const char* yaml) {
    config::ConfigReader reader(YAML::Load(yaml), "tracker.yaml");
    TrackerServiceConfig config;
    read(reader, config);
    EXPECT_NO_THROW(reader.finish());
    return config.tracker.depth.noise.name;
  };
  EXPECT_EQ(noise_by("{}"), "kinect_v1");
  EXPECT_EQ(noise_by("{camera: {preset: realsense}}"), "realsense");
  EXPECT_EQ(noise_by("{camera: {preset: realsense, depth_noise: ideal}}"), "ideal");
}

}  // namespace
}  // namespace rds::tracker
