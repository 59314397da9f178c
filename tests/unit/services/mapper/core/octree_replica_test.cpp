// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree_replica.hpp"

#include <random>

#include <gmock/gmock.h>

#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::SyntheticKeyframe;
constexpr std::uint64_t kEpoch = 0xabcdef;

/// Keyframes of random content and pose from a fixed seed.
class RandomKeyframes {
 public:
  KeyframeInput next() {
    SyntheticKeyframe keyframe(id_++, 2.0 + uniform_(random_));
    const int x = static_cast<int>(200 * uniform_(random_));
    const cv::Rect px(x, 60, 90, 120);
    keyframe.rectangle(px, 1.0 + uniform_(random_), cv::Scalar(255 * uniform_(random_), 80, 20));
    keyframe.box(uniform_(random_) < 0.5 ? "person" : "chair", px, uniform_(random_) < 0.5);
    return keyframe.pose(pose()).make();
  }
  geometry::Pose pose() {
    geometry::Pose pose(Eigen::AngleAxisd(0.6 * (uniform_(random_) - 0.5), Eigen::Vector3d::UnitY()));
    pose.translation() = Eigen::Vector3d(uniform_(random_), uniform_(random_), uniform_(random_));
    return pose;
  }

 private:
  std::mt19937 random_{7};
  std::uniform_real_distribution<double> uniform_{0, 1};
  std::uint64_t id_ = 0;
};

void expect_same(const OctreeReplica& replica, const SemanticMapper& mapper) {
  ASSERT_TRUE(replica.is_valid());
  EXPECT_EQ(replica.revision(), mapper.revision());
  EXPECT_EQ(to_bytes(replica.tree()), to_bytes(mapper.tree()));
  std::size_t different_labels = 0;
  for (auto leaf = replica.tree().begin_leafs(), end = replica.tree().end_leafs(); leaf != end; ++leaf)
    different_labels += replica.label(leaf.getKey()) != mapper.label(leaf.getKey()) ? 1U : 0U;
  EXPECT_EQ(different_labels, 0U);
}

TEST(OctreeReplica, FollowsARandomSequenceOfKeyframesAndCorrections) {
  RandomKeyframes keyframes;
  SemanticMapper mapper(MapperConfig{}, kEpoch);
  OctreeReplica replica;
  for (std::uint64_t id = 0; id < 8; ++id) {
    EXPECT_EQ(replica.apply(mapper.integrate(keyframes.next())).status, ReplicaStatus::kApplied);
    if (id % 4 == 3) {
      const std::vector<KeyframePose> moved{{id, 0, keyframes.pose()}, {id / 2, 0, keyframes.pose()}};
      EXPECT_EQ(replica.apply(mapper.apply_poses(moved)).status, ReplicaStatus::kApplied);
    }
    expect_same(replica, mapper);
  }
}

TEST(OctreeReplica, JoinsLateWithTheFullMapAndGoesOnWithDeltas) {
  RandomKeyframes keyframes;
  SemanticMapper mapper(MapperConfig{}, kEpoch);
  OctreeReplica replica;
  for (int i = 0; i < 4; ++i) mapper.integrate(keyframes.next());
  EXPECT_EQ(replica.apply(mapper.integrate(keyframes.next())).status, ReplicaStatus::kGap);
  EXPECT_FALSE(replica.is_valid());
  const auto full = to_bytes(mapper.tree());
  EXPECT_EQ(replica.apply_full(full, 0.05, kEpoch, mapper.revision(), mapper.labels().names()).status,
            ReplicaStatus::kApplied);
  expect_same(replica, mapper);
  EXPECT_EQ(replica.apply(mapper.integrate(keyframes.next())).status, ReplicaStatus::kApplied);
  expect_same(replica, mapper);
  EXPECT_EQ(replica.apply_full(full, 0.05, kEpoch, mapper.revision() - 1, {}).status, ReplicaStatus::kOld);
}

TEST(OctreeReplica, NoticesGapsOtherEpochsAndOtherResolutions) {
  RandomKeyframes keyframes;
  SemanticMapper mapper(MapperConfig{}, kEpoch);
  OctreeReplica replica;
  const auto first = mapper.integrate(keyframes.next());
  mapper.integrate(keyframes.next());
  auto third = mapper.integrate(keyframes.next());
  ASSERT_EQ(replica.apply(first).status, ReplicaStatus::kApplied);
  EXPECT_EQ(replica.apply(first).status, ReplicaStatus::kOld);
  EXPECT_EQ(replica.apply(third).status, ReplicaStatus::kGap);
  third.base_revision = 1;
  third.map_epoch = kEpoch + 1;
  EXPECT_EQ(replica.apply(third).status, ReplicaStatus::kOtherEpoch);
  third.map_epoch = kEpoch;
  third.resolution = 0.1;
  EXPECT_EQ(replica.apply(third).status, ReplicaStatus::kOtherResolution);
  EXPECT_EQ(replica.revision(), 1U);
}

TEST(OctreeReplica, RejectsHostileDeltasAndStaysAsItWas) {
  RandomKeyframes keyframes;
  SemanticMapper mapper(MapperConfig{}, kEpoch);
  OctreeReplica replica;
  ASSERT_EQ(replica.apply(mapper.integrate(keyframes.next())).status, ReplicaStatus::kApplied);
  const auto before = to_bytes(replica.tree());
  const auto good = mapper.integrate(keyframes.next());
  const auto status = [&](auto spoil) {
    auto bad = good;
    spoil(bad);
    const auto answer = replica.apply(bad);
    EXPECT_FALSE(answer.reason.empty());
    return answer.status;
  };
  EXPECT_EQ(status([](auto& d) { d.keys.pop_back(); }), ReplicaStatus::kMalformed);
  EXPECT_EQ(status([](auto& d) { d.labels.push_back(1); }), ReplicaStatus::kMalformed);
  EXPECT_EQ(status([](auto& d) { d.colors.clear(); }), ReplicaStatus::kMalformed);
  EXPECT_EQ(status([](auto& d) { d.deleted_keys.push_back(1); }), ReplicaStatus::kMalformed);
  EXPECT_EQ(status([](auto& d) { d.log_odds[0] = NAN; }), ReplicaStatus::kMalformed);
  EXPECT_EQ(status([](auto& d) { d.log_odds[0] = INFINITY; }), ReplicaStatus::kMalformed);
  EXPECT_EQ(status([](auto& d) { d.resolution = 0; }), ReplicaStatus::kMalformed);
  EXPECT_EQ(status([](auto& d) { d.resolution = NAN; }), ReplicaStatus::kMalformed);
  EXPECT_EQ(status([](auto& d) { d.revision = d.base_revision; }), ReplicaStatus::kMalformed);
  EXPECT_EQ(to_bytes(replica.tree()), before);
  EXPECT_EQ(replica.apply(good).status, ReplicaStatus::kApplied);
}

TEST(OctreeReplica, DeletingEverythingLeavesAnEmptyTree) {
  RandomKeyframes keyframes;
  SemanticMapper mapper(MapperConfig{}, kEpoch);
  OctreeReplica replica;
  const auto first = mapper.integrate(keyframes.next());
  ASSERT_EQ(replica.apply(first).status, ReplicaStatus::kApplied);
  MapDelta empty;
  empty.map_epoch = kEpoch;
  empty.base_revision = 1;
  empty.revision = 2;
  empty.resolution = 0.05;
  empty.deleted_keys = first.keys;
  EXPECT_EQ(replica.apply(empty).status, ReplicaStatus::kApplied);
  EXPECT_EQ(replica.tree().size(), 0U);
  EXPECT_TRUE(to_bytes(replica.tree()).empty());
}

}  // namespace
}  // namespace rds::mapper
