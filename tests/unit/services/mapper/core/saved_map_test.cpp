// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "services/mapper/core/objects/object_json.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"
#include "services/mapper/core/semantic_mapper.hpp"
#include "services/mapper/io/map_files.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::SyntheticKeyframe;
using ::testing::HasSubstr;

const cv::Rect kMonitor(120, 80, 60, 50);

geometry::Pose shifted(double x, double y, double z) {
  return geometry::make_pose({x, y, z}, Eigen::Quaterniond::Identity());
}

KeyframeInput keyframe(std::uint64_t id, double x = 0) {
  return SyntheticKeyframe(id)
      .rectangle(kMonitor, 2.0)
      .box("tvmonitor", kMonitor, false)
      .pose(shifted(x, 0, 0));
}

/// A map with a labelled object.
class SavedMapper : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    SemanticMapper mapper(MapperConfig{}, 5);
    for (std::uint64_t id = 0; id < 3; ++id) mapper.integrate(keyframe(id, 0.01 * static_cast<double>(id)));
    mapper.settle({});
    bytes = test::saved_bytes(mapper);
    objects = to_json(mapper.map().objects());
    tree = to_bytes(mapper.map().tree());
    up = mapper.up_in_map();
  }

  static inline map_file::Bytes bytes;
  static inline std::string objects;
  static inline std::vector<std::uint8_t> tree;
  static inline Eigen::Vector3d up;
};

TEST_F(SavedMapper, TheWholeMapComesBack) {
  SemanticMapper mapper(MapperConfig{}, 7);
  const auto read = test::start_from(mapper, bytes);
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(test::saved_bytes(mapper), bytes);
  EXPECT_EQ(to_bytes(mapper.map().tree()), tree);
  EXPECT_EQ(to_json(mapper.map().objects()), objects);
  EXPECT_EQ(mapper.up_in_map(), up);
  EXPECT_THAT(mapper.map().labels.names(), testing::ElementsAre("", "tvmonitor"));
  EXPECT_EQ(mapper.archive().size(), 0U) << "keyframes are not in it";
  EXPECT_EQ(mapper.map().epoch, 7U);
  EXPECT_EQ(mapper.map().revision, 1U);
}

TEST_F(SavedMapper, ItsTreeCanBeLookedInto) {
  const auto saved = tree_from_map_bytes(bytes);
  ASSERT_TRUE(saved) << saved.error();
  EXPECT_EQ(to_bytes(*saved->tree), tree);
  EXPECT_THAT(saved->labels, testing::ElementsAre("", "tvmonitor"));
  EXPECT_FALSE(tree_from_map_bytes(std::span(bytes).first(100)));
}

TEST_F(SavedMapper, GoesOnAsIfItHadNeverStopped) {
  SemanticMapper whole(MapperConfig{});
  for (std::uint64_t id = 0; id < 6; ++id) whole.integrate(keyframe(id, 0.01 * static_cast<double>(id)));
  SemanticMapper continued(MapperConfig{});
  ASSERT_TRUE(test::start_from(continued, bytes));
  for (std::uint64_t id = 3; id < 6; ++id) continued.integrate(keyframe(id, 0.01 * static_cast<double>(id)));
  EXPECT_EQ(to_bytes(continued.map().tree()), to_bytes(whole.map().tree()));
  EXPECT_EQ(to_json(continued.map().objects()), to_json(whole.map().objects()));
  continued.settle({});
  EXPECT_EQ(to_bytes(continued.map().tree()), to_bytes(whole.map().tree())) << "the loaded part is final";
}

TEST_F(SavedMapper, AnotherEpochStartsWithTheSavedMapAgain) {
  SemanticMapper mapper(MapperConfig{});
  ASSERT_TRUE(test::start_from(mapper, bytes));
  mapper.integrate(keyframe(3, 0.5));
  mapper.settle({});
  mapper.reset(9);
  EXPECT_EQ(test::saved_bytes(mapper), bytes);
  EXPECT_EQ(mapper.map().epoch, 9U);
}

TEST_F(SavedMapper, KeyframesBeyondTheLimitDoNotChangeWhatAnEpochStartsWith) {
  MapperConfig config;
  config.correction.max_keyframes = 1;
  SemanticMapper mapper(config);
  ASSERT_TRUE(test::start_from(mapper, bytes));
  for (std::uint64_t id = 3; id < 6; ++id) mapper.integrate(keyframe(id, 0.5));
  mapper.reset(1);
  EXPECT_EQ(to_bytes(mapper.map().tree()), tree);
}

TEST_F(SavedMapper, ARevisionIsNeverUsedTwiceInAnEpoch) {
  SemanticMapper mapper(MapperConfig{});
  for (std::uint64_t id = 0; id < 4; ++id) mapper.integrate(keyframe(id));
  ASSERT_TRUE(test::start_from(mapper, bytes));
  EXPECT_EQ(mapper.map().revision, 5U);
}

TEST_F(SavedMapper, TornBytesAreRefusedAndChangeNothing) {
  SemanticMapper mapper(MapperConfig{});
  for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 40)
    EXPECT_FALSE(test::start_from(mapper, std::span(bytes).first(size))) << size;
  EXPECT_EQ(mapper.map().tree().size(), 0U);
  EXPECT_EQ(mapper.map().revision, 0U);
}

TEST_F(SavedMapper, AlteredBytesDoNoHarm) {
  for (std::size_t at = 0; at < bytes.size(); at += 1 + bytes.size() / 15) {
    map_file::Bytes altered = bytes;
    altered[at] = static_cast<std::uint8_t>(~altered[at]);
    SemanticMapper mapper(MapperConfig{});
    if (test::start_from(mapper, altered)) mapper.integrate(keyframe(3));
  }
}

TEST_F(SavedMapper, SaysWhatDoesNotFit) {
  MapperConfig coarse;
  coarse.octree.resolution_m = 0.1;
  SemanticMapper mapper(coarse);
  const auto read = test::start_from(mapper, bytes, coarse);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error(), HasSubstr("voxels of 0.05 m, expected 0.1 m"));
}

}  // namespace
}  // namespace rds::mapper
