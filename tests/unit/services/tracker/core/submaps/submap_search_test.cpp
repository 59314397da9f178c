// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/submaps/submap_search.hpp"

#include <gtest/gtest.h>

#include "services/tracker/core/motion/se3.hpp"
#include "tests/unit/services/tracker/core/known_place.hpp"

namespace rds::tracker {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

/// Two keyframes of the map, and one of a submap that began after a while and sees the same points.
class SubmapSearch : public testing::Test, protected test::KnownPlace {
 protected:
  SubmapSearch() {
    add_keyframe(Pose::Identity());
    add_keyframe(test::pose(0.3, 0, 0, -0.1), kSecondNs);
  }
  /// @param submap_from_map  what the submap's frame is.
  KeyframeId begin_submap(double gap_s, const Pose& submap_from_map) {
    TrackedFrame frame = frame_at(there);
    frame.stamp_ns = frame.time_ns = kSecondNs + static_cast<std::int64_t>(gap_s * kSecondNs);
    frame.clear_matches();
    frame.camera_from_map = (submap_from_map * there).inverse();
    map.records().submaps().go_on(1, 2);
    return insert_keyframe(map, frame, settings.depth).id;
  }

  Pose there = test::pose(0.15, 0.05, -0.1, 0.1);
};

TEST_F(SubmapSearch, FindsTheKeyframeWhereTheCameraWasLost) {
  const Pose submap_from_map = geometry::make_pose(
      {0.4, -0.3, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ())));
  const KeyframeId id = begin_submap(1, submap_from_map);
  const auto found = find_around_loss(map, id);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->match.later, id);
  EXPECT_GE(found->inliers, 50);
  const Pose placed = map.pose_of(found->match.earlier) * found->match.earlier_from_later;
  EXPECT_TRUE(found->by_votes);
  EXPECT_LT(se3_log(placed.inverse() * there).norm(), 0.01);
}

TEST_F(SubmapSearch, DoesNotLookWhereTheCameraMayHaveWalkedAway) {
  EXPECT_FALSE(find_around_loss(map, begin_submap(6, Pose::Identity())));
}

TEST_F(SubmapSearch, LooksForNothingThatIsInTheMap) {
  EXPECT_FALSE(find_around_loss(map, 1));
  EXPECT_FALSE(find_around_loss(map, 7)) << "not there";
}

TEST_F(SubmapSearch, VotesAreConfirmedWhereTheCameraCanHaveWalked) {
  const auto found = find_around_loss(map, begin_submap(1, Pose::Identity()));
  ASSERT_TRUE(found);
  std::vector<FoundKeyframe> sightings(kAgreeingSightings, *found);
  EXPECT_TRUE(are_confirmed(map, sightings));
  EXPECT_FALSE(are_confirmed(map, std::span(sightings).first(kAgreeingSightings - 1)));
  for (FoundKeyframe& s : sightings) s.match.earlier_from_later.pretranslate(Eigen::Vector3d(8, 0, 0));
  EXPECT_FALSE(are_confirmed(map, sightings)) << "8 m in a second";
}

}  // namespace
}  // namespace rds::tracker
