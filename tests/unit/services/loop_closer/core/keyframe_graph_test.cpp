// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/keyframe_graph.hpp"

#include <gmock/gmock.h>

namespace rds::loop_closer {
namespace {

using geometry::Pose;

Pose at(double x) {
  return geometry::make_pose({x, 0, 0}, Eigen::Quaterniond::Identity());
}

/// Keyframes in a row, 0.2 m apart.
KeyframeGraph row(std::size_t count, double step = 0.2) {
  KeyframeGraph graph;
  for (std::uint64_t id = 0; id < count; ++id) {
    std::vector<Covisible> before;
    if (id > 0) before.push_back({id - 1, 200, at(step * static_cast<double>(id - 1))});
    graph.add({id, 0, at(step * static_cast<double>(id))}, before);
  }
  return graph;
}

TEST(KeyframeGraph, FollowsTheTrackerWhileNothingIsCorrected) {
  KeyframeGraph graph = row(5);
  graph.add({5, 0, at(1.05)},
            std::vector<Covisible>{{3, 200, at(0.61)}, {4, 200, at(0.83)}, {99, 200, at(7)}});
  EXPECT_EQ(graph.map_from_camera(3).translation().x(), 0.61);
  EXPECT_EQ(graph.map_from_camera(4).translation().x(), 0.83);
  EXPECT_EQ(graph.map_from_camera(1).translation().x(), 0.2);
}

TEST(KeyframeGraph, SpreadsALoopOverTheKeyframesBetween) {
  KeyframeGraph graph = row(21);
  const PoseGraphEdge loop{0, 20, at(3.8), EdgeKind::kLoop};  // the chain says 4.0 m
  ASSERT_TRUE(graph.close({&loop, 1}));
  EXPECT_EQ(graph.map_from_camera(0).translation().x(), 0);
  EXPECT_NEAR(graph.map_from_camera(10).translation().x(), 1.9, 0.02);
  EXPECT_NEAR(graph.map_from_camera(20).translation().x(), 3.8, 0.02);
}

TEST(KeyframeGraph, TakesBackALoopThatTheChainCannotFollow) {
  KeyframeGraph graph = row(21);
  const PoseGraphEdge absurd{0, 20, at(-30), EdgeKind::kLoop};
  EXPECT_FALSE(graph.close({&absurd, 1}));
  EXPECT_EQ(graph.map_from_camera(20).translation().x(), 4.0);
}

/// The tracker has not followed the correction yet when it makes the next keyframes: their relative poses
/// count.
TEST(KeyframeGraph, PutsNewKeyframesBehindCorrectedOnesInEitherFrameOfTheTracker) {
  KeyframeGraph graph = row(21);
  const PoseGraphEdge loop{0, 20, at(3.8), EdgeKind::kLoop};
  ASSERT_TRUE(graph.close({&loop, 1}));
  const double corrected = graph.map_from_camera(20).translation().x();
  const std::vector<Covisible> old_frame{{20, 200, at(4.0)}};
  graph.add({21, 0, at(4.2)}, old_frame);
  EXPECT_NEAR(graph.map_from_camera(21).translation().x(), corrected + 0.2, 1e-9);
  const std::vector<Covisible> new_frame{{21, 200, at(corrected + 0.2)}};
  graph.add({22, 0, at(corrected + 0.4)}, new_frame);
  EXPECT_NEAR(graph.map_from_camera(22).translation().x(), corrected + 0.4, 1e-9);
}

/// Once the tracker has joined a loop it knows best how its two ends stand to each other.
TEST(KeyframeGraph, TakesThePosesOfATrackerThatHasFollowed) {
  KeyframeGraph graph = row(21);
  const PoseGraphEdge loop{0, 20, at(3.8), EdgeKind::kLoop};
  ASSERT_TRUE(graph.close({&loop, 1}));
  std::vector<Covisible> adjusted{{20, 200, at(3.83)}};
  for (std::uint64_t id = 0; id < 20; ++id) adjusted.push_back({id, 0, at(0.1915 * static_cast<double>(id))});
  graph.add({21, 0, at(4.0)}, adjusted, true);
  EXPECT_EQ(graph.map_from_camera(20).translation().x(), 3.83);
  EXPECT_EQ(graph.map_from_camera(10).translation().x(), 1.915);
  // What was measured before the tracker joined it pulls no more.
  const PoseGraphEdge again{0, 21, at(4.0), EdgeKind::kLoop};
  ASSERT_TRUE(graph.close({&again, 1}));
  EXPECT_NEAR(graph.map_from_camera(20).translation().x(), 3.83, 1e-3);
}

TEST(KeyframeGraph, MeasuresTheTravelledPath) {
  EXPECT_NEAR(row(11).path_length(2, 7), 1.0, 1e-9);
  EXPECT_NEAR(row(11).path_length(7, 2), 1.0, 1e-9);
}

}  // namespace
}  // namespace rds::loop_closer
