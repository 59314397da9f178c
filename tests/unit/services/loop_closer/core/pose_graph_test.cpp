// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/pose_graph.hpp"

#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>

namespace rds::loop_closer {
namespace {

using geometry::Pose;

/// A walk around a circle of 2 m radius that ends where it began.
std::vector<Pose> circle(std::size_t count) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(count - 1);
    poses.push_back(
        geometry::make_pose({2 * std::sin(angle), 0, 2 * std::cos(angle)},
                            Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()))));
  }
  return poses;
}

/// Edges between consecutive poses, each a little too high and too far turned.
std::vector<PoseGraphEdge> drifting_edges(const std::vector<Pose>& truth) {
  std::vector<PoseGraphEdge> edges;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    Pose step = truth[i - 1].inverse() * truth[i];
    step.translation().y() += 0.01;
    step.linear() = step.linear() * Eigen::AngleAxisd(0.006, Eigen::Vector3d::UnitY()).toRotationMatrix();
    edges.push_back({i - 1, i, step, EdgeKind::kOdometry});
  }
  return edges;
}

std::vector<Pose> chained(const Pose& first, const std::vector<PoseGraphEdge>& edges) {
  std::vector<Pose> poses{first};
  for (const auto& edge : edges) poses.push_back(poses.back() * edge.from_from_to);
  return poses;
}

double rms_m(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i].translation() - b[i].translation()).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(PoseGraph, ALoopTakesEightyPercentOfTheDriftOfACircle) {
  const auto truth = circle(61);
  auto edges = drifting_edges(truth);
  auto poses = chained(truth[0], edges);
  const double before = rms_m(poses, truth);
  edges.push_back({0, 60, truth[0].inverse() * truth[60], EdgeKind::kLoop});
  ASSERT_TRUE(optimize_pose_graph(poses, edges));
  EXPECT_GT(before, 0.2);
  EXPECT_LT(rms_m(poses, truth), 0.2 * before);
  EXPECT_EQ(poses[0].matrix(), truth[0].matrix());
}

TEST(PoseGraph, LeavesPosesThatAgreeWithTheirEdges) {
  const auto truth = circle(20);
  std::vector<PoseGraphEdge> edges;
  for (std::size_t i = 1; i < truth.size(); ++i)
    edges.push_back({i - 1, i, truth[i - 1].inverse() * truth[i], EdgeKind::kOdometry});
  auto poses = truth;
  ASSERT_TRUE(optimize_pose_graph(poses, edges));
  EXPECT_LT(rms_m(poses, truth), 1e-9);
}

TEST(PoseGraph, GivesTheSameBytesEveryTime) {
  const auto truth = circle(61);
  auto edges = drifting_edges(truth);
  edges.push_back({0, 60, truth[0].inverse() * truth[60], EdgeKind::kLoop});
  auto first = chained(truth[0], edges);
  first.resize(truth.size());
  auto second = first;
  optimize_pose_graph(first, edges);
  optimize_pose_graph(second, edges);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].matrix(), second[i].matrix());
}

TEST(PoseGraph, RefusesEdgesToPosesThatAreNotThere) {
  auto poses = circle(3);
  const std::vector<PoseGraphEdge> beyond{{0, 3, Pose::Identity(), EdgeKind::kLoop}};
  const std::vector<PoseGraphEdge> itself{{1, 1, Pose::Identity(), EdgeKind::kLoop}};
  EXPECT_THROW(optimize_pose_graph(poses, beyond), std::invalid_argument);
  EXPECT_THROW(optimize_pose_graph(poses, itself), std::invalid_argument);
}

}  // namespace
}  // namespace rds::loop_closer
