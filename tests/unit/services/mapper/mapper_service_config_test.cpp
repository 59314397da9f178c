// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/mapper_service_config.hpp"

#include <gmock/gmock.h>

namespace rds::mapper {
namespace {

TEST(MapperServiceConfig, TakesTheDepthNoiseOfThePresetUnlessItIsSet) {
  const auto noise_by = [](const char* yaml) {
    config::ConfigReader reader(YAML::Load(yaml), "mapper.yaml");
    MapperServiceConfig config;
    read(reader, config);
    EXPECT_NO_THROW(reader.finish());
    return config.mapper.sampling.depth_noise.name;
  };
  EXPECT_EQ(noise_by("{}"), "kinect_v1");
  EXPECT_EQ(noise_by("{camera_preset: azure_kinect}"), "azure_kinect");
  EXPECT_EQ(noise_by("{camera_preset: azure_kinect, depth_noise: xtion}"), "xtion");
}

TEST(MapperServiceConfig, RefusesSettingsOfAMethodThatIsGone) {
  config::ConfigReader reader(YAML::Load("{segmentation: {enabled: false}}"), "mapper.yaml");
  MapperServiceConfig config;
  read(reader, config);
  try {
    reader.finish();
    FAIL() << "no violation found";
  } catch (const config::ConfigError& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("segmentation: unknown key"));
  }
}

}  // namespace
}  // namespace rds::mapper
