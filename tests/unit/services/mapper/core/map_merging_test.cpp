// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/map_merging.hpp"

#include <gmock/gmock.h>

#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using geometry::Pose;
using geometry::PoseChange;
using test::SyntheticKeyframe;

const cv::Rect kChair(100, 80, 80, 80);
const cv::Rect kMonitor(220, 60, 60, 60);
constexpr double kChairM = 2;
constexpr std::uint64_t kLooks = 6;  // keyframes of a visit

Pose at(double x, double turn_rad = 0) {
  return geometry::make_pose({x, 0.02, 0.12},
                             Eigen::Quaterniond(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY())));
}

/// Looks at a wall from several places. @param furnish  puts things before it.
template <class Furnish>
void look(SemanticMapper& mapper, std::uint64_t first, const Pose& map_from_room, Furnish furnish) {
  for (std::uint64_t i = 0; i < kLooks; ++i) {
    SyntheticKeyframe keyframe(first + i);
    furnish(keyframe.looked_for_objects());
    mapper.integrate(keyframe.pose(map_from_room * at(0.01 * static_cast<double>(i))));
  }
}

/// A saved map of a few such looks.
template <class Furnish>
SavedMap visit(const Pose& map_from_room, Furnish furnish) {
  SemanticMapper mapper(MapperConfig{});
  look(mapper, 0, map_from_room, furnish);
  mapper.settle({});
  auto saved = saved_map_from(test::saved_bytes(mapper), MapperConfig{});
  if (!saved) throw std::runtime_error(saved.error());
  return std::move(*saved);
}

void nothing(SyntheticKeyframe& /*keyframe*/) {}
void chair(SyntheticKeyframe& keyframe) {
  keyframe.rectangle(kChair, kChairM).box("chair", kChair, false);
}
void monitor(SyntheticKeyframe& keyframe) {
  keyframe.rectangle(kMonitor, 2.2).box("tvmonitor", kMonitor, false);
}

/// A map as those see it who go on in it.
std::unique_ptr<SemanticMapper> mapper_of(const SavedMap& saved) {
  auto mapper = std::make_unique<SemanticMapper>(MapperConfig{});
  mapper->start_from(saved);
  return mapper;
}

std::vector<PoseChange> changes(const Pose& later_from_earlier) {
  std::vector<PoseChange> moved;
  for (const double x : {0.0, 0.05}) moved.push_back({later_from_earlier * at(x), at(x)});
  return moved;
}

MergedMap merged(const SavedMap& earlier, const SavedMap& later,
                 const Pose& later_from_earlier = Pose::Identity()) {
  return merge_maps(earlier, later, changes(later_from_earlier), MapperConfig{});
}

/// Share of the occupied voxels of a map in whose 3×3×3 neighbourhood the other one has an occupied voxel.
double covered(const octomap::ColorOcTree& tree, const octomap::ColorOcTree& by) {
  int voxels = 0;
  int found = 0;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    ++voxels;
    bool is_near = false;
    for (int i = 0; i < 27; ++i) {
      octomap::OcTreeKey key = leaf.getKey();
      key[0] = static_cast<std::uint16_t>(key[0] + i % 3 - 1);
      key[1] = static_cast<std::uint16_t>(key[1] + i / 3 % 3 - 1);
      key[2] = static_cast<std::uint16_t>(key[2] + i / 9 - 1);
      const auto* node = by.search(key);
      is_near = is_near || (node != nullptr && by.isNodeOccupied(*node));
    }
    found += is_near ? 1 : 0;
  }
  return voxels > 0 ? static_cast<double>(found) / voxels : 0;
}

Eigen::Vector3d on_chair() {
  return at(0) * test::point_at(140, 120, kChairM);
}

const Pose kTurned = geometry::make_pose(
    {0.53, -0.21, 0.34},
    Eigen::Quaterniond(Eigen::AngleAxisd(0.6, Eigen::Vector3d(0.1, 1, 0.2).normalized())));

TEST(MapMerging, AMapThatAddsNothingChangesNothing) {
  const SavedMap room = visit(Pose::Identity(), chair);
  const MergedMap both = merged(room, room);
  EXPECT_EQ(both.voxels.appeared, 0U);
  EXPECT_EQ(both.voxels.vanished, 0U);
  EXPECT_EQ(both.common_objects, 1U);
  EXPECT_EQ(both.gone_objects, 0U);
  const auto before = mapper_of(room);
  const auto after = mapper_of(both.saved);
  for (auto leaf = before->map().tree().begin_leafs(), end = before->map().tree().end_leafs(); leaf != end;
       ++leaf) {
    const auto* node = after->map().tree().search(leaf.getKey());
    ASSERT_NE(node, nullptr);
    EXPECT_EQ(node->getLogOdds() > 0, leaf->getLogOdds() > 0);
  }
}

TEST(MapMerging, AMapInAnotherFrameGoesToItsPlace) {
  const SavedMap earlier = visit(Pose::Identity(), nothing);
  const SavedMap later = visit(kTurned, chair);
  const MergedMap both = merged(earlier, later, kTurned);
  EXPECT_GT(both.voxels.appeared, 100U);
  SemanticMapper wanted(MapperConfig{});  // had it been one run
  look(wanted, 0, Pose::Identity(), nothing);
  look(wanted, kLooks, Pose::Identity(), chair);
  const auto got = mapper_of(both.saved);
  EXPECT_GT(covered(wanted.map().tree(), got->map().tree()), 0.98);
  EXPECT_GT(covered(got->map().tree(), wanted.map().tree()), 0.98);
  const auto objects = got->map().objects();
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_EQ(objects[0].label, "chair");
  EXPECT_LT((objects[0].center - on_chair()).norm(), 0.1);
}

TEST(MapMerging, NoHolesAreTornIntoWallsThatBothHave) {
  const SavedMap earlier = visit(Pose::Identity(), nothing);
  const MergedMap both = merged(earlier, visit(kTurned, nothing), kTurned);
  const auto before = mapper_of(earlier);
  EXPECT_GT(covered(before->map().tree(), mapper_of(both.saved)->map().tree()), 0.999);
}

TEST(MapMerging, WhatTheLaterMapDoesNotHaveAnyMoreIsGone) {
  for (const Pose& later_from_earlier : {Pose::Identity(), kTurned}) {
    const SavedMap earlier = visit(Pose::Identity(), chair);
    const MergedMap both = merged(earlier, visit(later_from_earlier, monitor), later_from_earlier);
    EXPECT_GT(both.voxels.vanished, 50U);
    EXPECT_EQ(both.gone_objects, 1U);
    EXPECT_EQ(both.common_objects, 0U);
    const auto mapper = mapper_of(both.saved);
    EXPECT_TRUE(test::is_occupied(mapper_of(earlier)->map().tree(), on_chair()));
    EXPECT_FALSE(test::is_occupied(mapper->map().tree(), on_chair()));
    const auto objects = mapper->map().objects();
    ASSERT_EQ(objects.size(), 2U);
    EXPECT_EQ(objects[0].label, "chair");
    EXPECT_TRUE(objects[0].has_gone);
    EXPECT_EQ(objects[1].label, "tvmonitor");
    EXPECT_FALSE(objects[1].has_gone);
    EXPECT_EQ(objects[1].id, objects[0].id + 1);
  }
}

TEST(MapMerging, WhatTheLaterMapDidNotLookAtStays) {
  const SavedMap earlier = visit(Pose::Identity(), chair);
  const Pose elsewhere = geometry::make_pose({0, 0, -20}, Eigen::Quaterniond::Identity());
  const MergedMap both = merged(earlier, visit(Pose::Identity(), monitor), elsewhere);
  EXPECT_EQ(both.voxels.vanished, 0U);
  EXPECT_EQ(both.common_objects, 0U);
  EXPECT_EQ(both.gone_objects, 0U);
  EXPECT_EQ(mapper_of(both.saved)->map().objects().size(), 2U);
}

TEST(MapMerging, AnObjectOfBothIsOneWithTheEvidenceOfBoth) {
  const SavedMap earlier = visit(Pose::Identity(), chair);
  const SavedMap later = visit(kTurned, [](SyntheticKeyframe& keyframe) {
    monitor(keyframe);  // so that labels and ids are others
    chair(keyframe);
  });
  const MergedMap both = merged(earlier, later, kTurned);
  EXPECT_EQ(both.common_objects, 1U);
  const auto mapper = mapper_of(both.saved);
  const auto objects = mapper->map().objects();
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].label, "chair");
  EXPECT_EQ(objects[0].id, mapper_of(earlier)->map().objects()[0].id);
  EXPECT_EQ(objects[0].observations, 2 * kLooks);
  EXPECT_EQ(objects[1].label, "tvmonitor");
  const Eigen::Vector3d middle = on_chair();
  const auto key = mapper->map().tree().coordToKey(middle.x(), middle.y(), middle.z());
  EXPECT_EQ(mapper->map().labels.names()[mapper->map().label(key)], "chair");
}

TEST(MapMerging, AnObjectThatHadGoneIsBackWithItsId) {
  const SavedMap first = visit(Pose::Identity(), chair);
  const MergedMap without = merged(first, visit(Pose::Identity(), nothing));
  ASSERT_EQ(without.gone_objects, 1U);
  const MergedMap again = merged(without.saved, visit(Pose::Identity(), chair));
  EXPECT_EQ(again.common_objects, 1U);
  const auto objects = mapper_of(again.saved)->map().objects();
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_FALSE(objects[0].has_gone);
  EXPECT_EQ(objects[0].id, mapper_of(first)->map().objects()[0].id);
  EXPECT_TRUE(test::is_occupied(mapper_of(again.saved)->map().tree(), on_chair()));
}

}  // namespace
}  // namespace rds::mapper
