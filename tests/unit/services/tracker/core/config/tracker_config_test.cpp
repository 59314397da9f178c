// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/config/tracker_config.hpp"

#include <gtest/gtest.h>

#include "common/config/config_reader.hpp"

namespace rds::tracker {
namespace {

TEST(TrackerConfig, NamesWhatIsOutOfRange) {
  config::ConfigReader reader(YAML::Load("extraction: {features: 5}\nkeyframe: {typo: 1}"), "test.yaml");
  TrackerConfig config;
  read(reader, config);
  try {
    reader.finish();
    FAIL() << "expected a complaint";
  } catch (const config::ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("extraction.features: 5, expected 100"), std::string::npos)
        << e.what();
    EXPECT_NE(std::string(e.what()).find("keyframe.typo: unknown key"), std::string::npos) << e.what();
  }
}

TEST(TrackerConfig, UpIsADirection) {
  for (const char* no_direction : {"[1, 2]", "[0, 0, 0]", "[.nan, 0, 1]"}) {
    config::ConfigReader reader(YAML::Load(std::string("map_frame: {up_in_camera: ") + no_direction + "}"),
                                "test.yaml");
    TrackerConfig config;
    read(reader, config);
    EXPECT_THROW(reader.finish(), config::ConfigError) << no_direction;
  }
}

}  // namespace
}  // namespace rds::tracker
