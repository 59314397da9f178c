// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/keyframe_bytes.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "services/loop_closer/core/loop_closer.hpp"
#include "tests/unit/services/loop_closer/core/synthetic_places.hpp"

namespace rds::loop_closer {
namespace {

KeyframeFeatures keyframe(std::uint64_t id, double angle_rad) {
  static const SyntheticWorld kWorld = SyntheticWorld::round_room(3000, 1);
  KeyframeFeatures features = kWorld.seen_from(looking_out(angle_rad), id);
  features.map_epoch = 5;
  features.id = id;
  features.stamp_ns = static_cast<std::int64_t>(id) * 100'000'000;
  features.points[0].setConstant(std::numeric_limits<float>::quiet_NaN());
  features.movable[1] = 1;
  if (id > 0) features.covisible.push_back({id - 1, 80, looking_out(angle_rad - 0.2)});
  return features;
}

TEST(LoopKeyframeBytes, ComeBackAsTheyWere) {
  const auto before = keyframe(7, 1.0);
  const auto bytes = to_bytes(before);
  const auto after = keyframe_from_bytes(bytes);
  ASSERT_TRUE(after) << after.error();
  EXPECT_EQ(after->id, before.id);
  EXPECT_EQ(after->points.size(), before.points.size());
  EXPECT_EQ(cv::norm(after->descriptors, before.descriptors, cv::NORM_HAMMING), 0);
  EXPECT_TRUE(to_bytes(*after) == bytes);
}

TEST(LoopKeyframeBytes, AnyByteMissingIsRefused) {
  const auto bytes = to_bytes(keyframe(7, 1.0));
  for (std::size_t size = 0; size < bytes.size(); size += size < 300 ? 1 : 997)
    EXPECT_FALSE(keyframe_from_bytes(std::span(bytes).first(size))) << size;
}

/// The path drifts while the camera turns twice.
std::vector<KeyframeFeatures> two_turns() {
  std::vector<KeyframeFeatures> keyframes;
  for (std::uint64_t id = 0; id < 60; ++id) {
    auto next = keyframe(id, 0.21 * static_cast<double>(id));
    const Eigen::Translation3d drift(0.006 * static_cast<double>(id), 0, 0);
    next.map_from_camera = drift * next.map_from_camera;
    for (auto& other : next.covisible) other.map_from_camera = drift * other.map_from_camera;
    keyframes.push_back(next);
  }
  return keyframes;
}

TEST(LoopKeyframeBytes, ShownAgainGiveTheSameLoopCloser) {
  LoopCloser through;
  LoopCloser again;
  const auto keyframes = two_turns();
  std::vector<LoopAnswer> expected;
  for (const auto& next : keyframes) expected.push_back(through.add(next));
  ASSERT_GT(through.revision(), 0U) << "nothing was closed";
  for (std::size_t i = 0; i < 45; ++i) again.add(*keyframe_from_bytes(to_bytes(keyframes[i])));
  again.count_anew();
  EXPECT_EQ(again.revision(), 0U);
  for (std::size_t i = 45; i < keyframes.size(); ++i) {
    const auto answer = again.add(keyframes[i]);
    ASSERT_EQ(answer.poses.size(), expected[i].poses.size()) << i;
    for (std::size_t k = 0; k < answer.poses.size(); ++k)
      EXPECT_TRUE(answer.poses[k].map_from_camera.matrix() == expected[i].poses[k].map_from_camera.matrix());
  }
  EXPECT_EQ(again.poses().size(), through.poses().size());
  for (std::size_t k = 0; k < again.poses().size(); ++k)
    EXPECT_TRUE(again.poses()[k].map_from_camera.matrix() == through.poses()[k].map_from_camera.matrix()) << k;
}

}  // namespace
}  // namespace rds::loop_closer
