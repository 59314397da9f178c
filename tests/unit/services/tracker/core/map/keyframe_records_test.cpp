// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/keyframe_records.hpp"

#include <gtest/gtest.h>

#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

TEST(KeyframeRecords, PosesOfKeyframesInAKnownPlaceAreForgottenAfterAMinute) {
  constexpr std::int64_t kSecond = 999'000'000;  // so that nothing is just a minute old
  KeyframeRecords records;
  for (int k = 0; k < 4; ++k) records.add(k);
  const auto pass = [&](KeyframeId anchor, int begin_s, int end_s) {
    for (int s = begin_s; s < end_s; ++s) {
      records.add_pose_only(s * kSecond, anchor, Pose::Identity());
      records.forget_pose_only(anchor, s * kSecond);
    }
  };
  pass(0, 0, 60);
  EXPECT_EQ(records.all().size(), 64U) << "of the last minute all";
  pass(0, 60, 600);
  EXPECT_EQ(records.all().size(), 4U + 61U);
  pass(0, 900, 901);
  EXPECT_EQ(records.all().size(), 4U + 20U) << "and always some, however old";
  EXPECT_FALSE(records.contains(4));
  EXPECT_EQ(records.next_id(), 4U + 601U) << "no id is used twice";
  pass(1, 900, 903);
  EXPECT_EQ(records.all().size(), 4U + 20U + 3U) << "each place by itself";
}

TEST(KeyframeRecords, APoseIsRelativeToTheKeyframeAtTheEndOfItsAnchors) {
  KeyframeRecords records;
  for (int k = 0; k < 3; ++k) records.add(k);
  const Pose step = test::pose(0.1, 0, 0, 0.2);
  records.set_anchor(2, 1, step);
  EXPECT_EQ(records.anchor_of(2).first, 1U);
  records.set_anchor(1, 0, step);
  EXPECT_EQ(records.anchor_of(2).first, 0U);
  EXPECT_TRUE(records.anchor_of(2).second.isApprox(step * step, 1e-12));
  EXPECT_EQ(records.anchor_of(0).first, 0U);
  EXPECT_THROW((void)records.anchor_of(3), std::out_of_range);
}

TEST(KeyframeRecords, TheKeyframesThereAreCanBeFixed) {
  KeyframeRecords records;
  records.add(0);
  records.skip_ids(10);
  records.fix_all();
  EXPECT_EQ(records.add(1), 10U);
  EXPECT_TRUE(records.is_fixed(0));
  EXPECT_FALSE(records.is_fixed(10));
}

}  // namespace
}  // namespace rds::tracker
