// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/scene_history.hpp"

#include <gtest/gtest.h>

#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::SyntheticKeyframe;

constexpr double kDepthM = 1.52;
const cv::Rect kBody(120, 30, 80, 180);

std::int64_t stamp_ns(std::uint64_t keyframe) {
  return SyntheticKeyframe(keyframe).make().stamp_ns;
}

class SceneHistoryTest : public testing::Test {
 protected:
  void see_static(std::uint64_t keyframe) { see(SyntheticKeyframe(keyframe).rectangle(kBody, kDepthM)); }
  void see_person(std::uint64_t keyframe) {
    see(SyntheticKeyframe(keyframe).rectangle(kBody, kDepthM).box("person", kBody, true));
  }
  [[nodiscard]] bool is_ghost(std::uint64_t keyframe) const {
    return history_.is_ghost(key(), stamp_ns(keyframe));
  }
  [[nodiscard]] bool is_transient() const { return history_.is_transient(key(), 1'000'000'000); }

 private:
  [[nodiscard]] octomap::OcTreeKey key() const {
    const octomap::ColorOcTree tree(config_.octree.resolution_m);
    const Eigen::Vector3d p = test::point_at(160, 120, kDepthM);
    return tree.coordToKey(p.x(), p.y(), p.z());
  }
  void see(const KeyframeInput& input) { history_.see(test::record_of(input, labels_, config_), config_); }

  MapperConfig config_;
  LabelTable labels_;
  SceneHistory history_{{}, DynamicHistory(config_.octree.resolution_m)};
};

TEST_F(SceneHistoryTest, WhereNothingMovableHasBeenNothingIsSuspect) {
  see_static(0);
  EXPECT_FALSE(is_ghost(1));
}

TEST_F(SceneHistoryTest, WhatIsStaticAsOftenAsMovableIsNotSuspect) {
  see_static(0);
  for (const std::uint64_t keyframe : {1, 2}) see_person(keyframe);
  EXPECT_TRUE(is_ghost(9));
  see_static(3);
  EXPECT_FALSE(is_ghost(9));
}

TEST_F(SceneHistoryTest, WhatIsSeenThereAgainHasNotGone) {
  see_static(0);
  for (const std::uint64_t keyframe : {1, 2, 3}) see_person(keyframe);
  EXPECT_TRUE(is_ghost(4));
  see_static(5);
  EXPECT_FALSE(is_ghost(4));
  EXPECT_TRUE(is_ghost(6));
}

TEST_F(SceneHistoryTest, WhatStandsOnlyWhileSomebodyIsThereIsPassing) {
  see_person(20);
  EXPECT_TRUE(is_transient());
  see_static(11);
  see_person(30);
  EXPECT_TRUE(is_transient());
  see_static(25);
  EXPECT_FALSE(is_transient()) << "as often as dynamic";
}

TEST_F(SceneHistoryTest, WhatStandsASecondBeforeOrAfterIsNotPassing) {
  for (const std::uint64_t keyframe : {20, 21, 22}) see_person(keyframe);
  see_static(10);
  EXPECT_FALSE(is_transient());
}

TEST_F(SceneHistoryTest, WhereNobodyHasBeenNothingIsPassing) {
  see_static(0);
  EXPECT_FALSE(is_transient());
}

}  // namespace
}  // namespace rds::mapper
