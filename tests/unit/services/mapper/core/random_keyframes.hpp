// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

#include <gtest/gtest.h>

#include "services/mapper/core/map_snapshot.hpp"
#include "services/mapper/core/octree/octree_replica.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper::test {

/// Keyframes of random content and pose; the same seed gives the same.
class RandomKeyframes {
 public:
  explicit RandomKeyframes(unsigned seed = 7, std::vector<std::string> labels = {"person", "chair"})
      : random_(seed), labels_(std::move(labels)) {}

  KeyframeInput next() {
    SyntheticKeyframe keyframe(id_++, 2.0 + uniform());
    const cv::Rect px(below(200), 60, 90, 120);
    keyframe.rectangle(px, 1.0 + uniform(), cv::Scalar(255 * uniform(), 80, 20));
    const bool movable = uniform() < 0.5;
    keyframe.box(labels_[static_cast<std::size_t>(below(static_cast<int>(labels_.size())))], px, movable);
    return keyframe.pose(pose()).make();
  }
  geometry::Pose pose() {
    geometry::Pose pose(Eigen::AngleAxisd(0.6 * (uniform() - 0.5), Eigen::Vector3d::UnitY()));
    pose.translation() = Eigen::Vector3d(uniform(), uniform(), uniform());
    return pose;
  }
  double uniform() { return uniform_(random_); }
  int below(int limit) { return static_cast<int>(limit * uniform()); }

 private:
  std::mt19937 random_;
  std::vector<std::string> labels_;
  std::uniform_real_distribution<double> uniform_{0, 1};
  std::uint64_t id_ = 0;
};

/// The full map as the service publishes it.
struct PublishedMap {
  PublishedMap(const SemanticMapper& mapper, std::uint64_t map_id)
      : snapshot(take_snapshot(mapper)),
        untold(labels_not_shown_by_colors(mapper.map().tree(), snapshot)),
        full{snapshot.nodes,        snapshot.resolution, mapper.map().epoch, map_id,
             mapper.map().revision, snapshot.labels,     untold.keys,        untold.values} {}
  PublishedMap(const PublishedMap&) = delete;
  PublishedMap& operator=(const PublishedMap&) = delete;

  MapSnapshot snapshot;
  LabelRows untold;
  FullMap full;
};

/// Bit for bit, label for label.
inline void expect_same(const OctreeReplica& replica, const SemanticMapper& mapper) {
  ASSERT_TRUE(replica.is_valid());
  EXPECT_EQ(replica.revision(), mapper.map().revision);
  EXPECT_TRUE(to_bytes(replica.tree()) == to_bytes(mapper.map().tree()));
  std::size_t different_labels = 0;
  for (auto leaf = replica.tree().begin_leafs(), end = replica.tree().end_leafs(); leaf != end; ++leaf)
    different_labels += replica.label(leaf.getKey()) != mapper.map().label(leaf.getKey()) ? 1U : 0U;
  EXPECT_EQ(different_labels, 0U);
}

}  // namespace rds::mapper::test
