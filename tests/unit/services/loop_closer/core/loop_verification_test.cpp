// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/loop_verification.hpp"

#include <gmock/gmock.h>

#include "tests/unit/services/loop_closer/core/synthetic_places.hpp"

namespace rds::loop_closer {
namespace {

TEST(LoopVerification, FindsHowTwoViewsOfAPlaceStandToEachOther) {
  const auto world = SyntheticWorld::round_room(2000, 1);
  const auto query = world.seen_from(looking_out(0.1), 1);
  const auto candidate = world.seen_from(looking_out(0.0), 2);
  const auto loop = verify_loop(view_of_all(query), view_of_all(candidate));
  ASSERT_TRUE(loop);
  const geometry::Pose truth = looking_out(0.0).inverse() * looking_out(0.1);
  const geometry::Pose error = loop->candidate_from_query.inverse() * truth;
  EXPECT_LT(error.translation().norm(), 0.01);
  EXPECT_LT(geometry::rotation_angle_rad(error.linear()), 0.005);
  EXPECT_GT(loop->inlier_share, 0.7);
}

TEST(LoopVerification, RefusesAnotherPlace) {
  const auto world = SyntheticWorld::round_room(2000, 1);
  const auto query = world.seen_from(looking_out(3.0), 1);
  const auto candidate = world.seen_from(looking_out(0.0), 2);
  EXPECT_FALSE(verify_loop(view_of_all(query), view_of_all(candidate)));
}

/// The same pattern over and over, as on wallpaper: descriptors agree everywhere, the geometry does not.
TEST(LoopVerification, RefusesRepeatedTextureWithoutGeometry) {
  const auto world = SyntheticWorld::round_room(2000, 1);
  const auto query = world.seen_from(looking_out(0.0), 1);
  auto candidate = world.seen_from(looking_out(0.0), 2);
  cv::RNG rng(7);
  for (auto& point : candidate.points)
    point = Eigen::Vector3f(rng.uniform(-1.0F, 1.0F), rng.uniform(-1.0F, 1.0F), rng.uniform(1.5F, 3.5F));
  EXPECT_FALSE(verify_loop(view_of_all(query), view_of_all(candidate)));
}

/// The same small thing in two rooms: its features fit, the rest of the view does not.
TEST(LoopVerification, RefusesASmallCommonThingInDifferentSurroundings) {
  const auto room = SyntheticWorld::round_room(1500, 1);
  const auto other_room = SyntheticWorld::round_room(1500, 2);
  SyntheticWorld thing = SyntheticWorld::round_room(60, 3);
  for (auto& point : thing.points) point = Eigen::Vector3d(0, 0, 3) + 0.04 * point;
  const auto with_thing = [&](const SyntheticWorld& world) {
    SyntheticWorld both = world;
    both.points.insert(both.points.end(), thing.points.begin(), thing.points.end());
    both.descriptors.push_back(thing.descriptors);
    return both;
  };
  const auto query = with_thing(room).seen_from(looking_out(0.0), 1);
  const auto candidate = with_thing(other_room).seen_from(looking_out(0.0), 2);
  EXPECT_FALSE(verify_loop(view_of_all(query), view_of_all(candidate)));
}

TEST(LoopVerification, TakesEmptyViews) {
  EXPECT_FALSE(verify_loop({}, {}));
}

}  // namespace
}  // namespace rds::loop_closer
