// SPDX-License-Identifier: Apache-2.0
// The YAML beside each service says every setting, with its default.
#include <gmock/gmock.h>

#include "services/detector/detector_service_config.hpp"
#include "services/loop_closer/loop_closer_service_config.hpp"
#include "services/mapper/mapper_service_config.hpp"
#include "services/tracker/tracker_service_config.hpp"
#include "services/transformer/transformer_service_config.hpp"
#include "services/viewer/viewer_service_config.hpp"

namespace rds {
namespace {

/// @param file  below services/.
template <class Config>
void expect_every_default(const std::string& file) {
  auto reader = config::ConfigReader::from_file(RDS_SOURCE_DIR "/services/" + file);
  Config shipped;
  read(reader, shipped);
  EXPECT_NO_THROW(reader.finish());
  EXPECT_THAT(reader.absent(), ::testing::IsEmpty());
  EXPECT_TRUE(shipped == Config{}) << "a value in the file is not the default";
}

TEST(ShippedSettings, Detector) {
  expect_every_default<detector::DetectorServiceConfig>("detector/detector.yaml");
}
TEST(ShippedSettings, LoopCloser) {
  expect_every_default<loop_closer::LoopCloserServiceConfig>("loop_closer/loop_closer.yaml");
}
TEST(ShippedSettings, Mapper) {
  expect_every_default<mapper::MapperServiceConfig>("mapper/mapper.yaml");
}
TEST(ShippedSettings, Tracker) {
  expect_every_default<tracker::TrackerServiceConfig>("tracker/tracker.yaml");
}
TEST(ShippedSettings, Transformer) {
  expect_every_default<transformer::TransformerServiceConfig>("transformer/transformer.yaml");
}

TEST(ShippedSettings, Viewer) {
  expect_every_default<viewer::ViewerServiceConfig>("viewer/viewer.yaml");
}

}  // namespace
}  // namespace rds
