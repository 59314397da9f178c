// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/map_bytes.hpp"

#include <gmock/gmock.h>

#include "services/loop_closer/core/loop_closer.hpp"
#include "tests/unit/services/loop_closer/core/synthetic_places.hpp"

namespace rds::loop_closer {
namespace {

using geometry::Pose;
using ::testing::HasSubstr;

constexpr double kStep = 0.2;  // radians between keyframes
constexpr std::size_t kSaved = 32;

/// Keyframes once around a round room, saved with their true poses; and a camera that later goes around
/// again.
class SavedKeyframes : public ::testing::Test {
 protected:
  SavedKeyframes() {
    LoopCloser closer;
    for (std::size_t i = 0; i < kSaved; ++i) {
      const auto answer = closer.add(keyframe(i, looking_out(kStep * static_cast<double>(i)), {}, 1));
      EXPECT_EQ(answer.refused, "");
    }
    poses = closer.poses();
    bytes = closer.to_bytes();
  }

  KeyframeFeatures keyframe(std::uint64_t id, const Pose& estimate, std::vector<Covisible> covisible,
                            std::uint64_t epoch) const {
    const Pose truth = looking_out(kStep * static_cast<double>(id % kSaved));
    KeyframeFeatures features = world.seen_from(truth, id);
    features.map_epoch = epoch;
    features.id = id;
    features.map_from_camera = estimate;
    features.covisible = std::move(covisible);
    return features;
  }

  SyntheticWorld world = SyntheticWorld::round_room(1500, 1);
  std::vector<KeyframePose> poses;
  map_file::Bytes bytes;
};

TEST_F(SavedKeyframes, TheSameBytesComeOut) {
  LoopCloser closer;
  const auto read = closer.start_from(bytes, poses);
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(closer.to_bytes(), bytes);
  EXPECT_TRUE(closer.poses().empty()) << "they are of no epoch of this closer";
}

TEST_F(SavedKeyframes, ALoopToASavedPlaceMovesTheNewKeyframesAlone) {
  LoopCloser closer;
  ASSERT_TRUE(closer.start_from(bytes, poses));
  std::vector<Covisible> recent;
  Pose estimate = poses[0].map_from_camera;
  double before = 0;
  double after = 0;
  for (std::size_t i = 0; i < 30 && closer.revision() == 0; ++i) {
    const Pose truth = looking_out(kStep * static_cast<double>(i));
    if (i > 0) {
      Pose step = looking_out(kStep * static_cast<double>(i - 1)).inverse() * truth;
      step.translation() += Eigen::Vector3d(0.004, 0.012, 0);
      estimate = estimate * step;
    } else {
      recent.push_back({0, 300, poses[0].map_from_camera});
    }
    KeyframeFeatures features = keyframe(kSaved + i, estimate, recent, 2);
    if (i < 8) features.points.assign(features.points.size(), Eigen::Vector3f::Zero());  // drifts unseen
    const auto answer = closer.add(features);
    EXPECT_EQ(answer.refused, "");
    recent.insert(recent.begin(), {kSaved + i, 200, estimate});
    if (recent.size() > 3) recent.pop_back();
    if (answer.poses.empty()) continue;
    ASSERT_EQ(answer.poses.size(), i + 1);
    EXPECT_EQ(answer.poses.front().id, kSaved);
    before = (estimate.translation() - truth.translation()).norm();
    after = (answer.poses.back().map_from_camera.translation() - truth.translation()).norm();
  }
  ASSERT_EQ(closer.revision(), 1U);
  EXPECT_GT(before, 0.02);
  EXPECT_LT(after, 0.4 * before);
}

TEST_F(SavedKeyframes, AnotherEpochStartsWithThemAgain) {
  LoopCloser closer;
  ASSERT_TRUE(closer.start_from(bytes, poses));
  closer.add(keyframe(kSaved, poses[0].map_from_camera, {}, 2));
  EXPECT_NE(closer.to_bytes(), bytes);
  closer.add(keyframe(kSaved, poses[0].map_from_camera, {}, 3));
  EXPECT_EQ(closer.poses().size(), 1U);
  closer.reset();
  EXPECT_EQ(closer.to_bytes(), bytes);
}

TEST_F(SavedKeyframes, TornBytesAreRefusedAndChangeNothing) {
  LoopCloser closer;
  for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 40)
    EXPECT_FALSE(closer.start_from(std::span(bytes).first(size), poses)) << size;
  EXPECT_EQ(closer.to_bytes(), LoopCloser().to_bytes());
}

TEST_F(SavedKeyframes, AKeyframeWithoutAPoseIsNamed) {
  LoopCloser closer;
  poses.erase(poses.end() - 2);
  EXPECT_THAT(closer.start_from(bytes, poses).error(), HasSubstr("keyframe 30, which has no pose"));
}

TEST_F(SavedKeyframes, ThoseThatCameAfterThePosesWereSavedAreLeftOut) {
  LoopCloser closer;
  poses.pop_back();
  ASSERT_TRUE(closer.start_from(bytes, poses));
  EXPECT_EQ(closer.keyframes(), poses.size());
  EXPECT_LT(closer.to_bytes().size(), bytes.size());
}

TEST_F(SavedKeyframes, ThoseThatCameAfterThePosesWereSavedAreLeftOutOfAMergedMap) {
  constexpr std::uint64_t kFirst = 20;
  const auto both = merge_maps(bytes, bytes, kFirst);
  ASSERT_TRUE(both) << both.error();
  std::vector<KeyframePose> of_both(poses.begin(), poses.begin() + kFirst);
  for (const KeyframePose& p : poses) of_both.push_back({p.id + kFirst, p.stamp_ns, p.map_from_camera});
  LoopCloser closer;
  const auto read = closer.start_from(*both, of_both);
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(closer.keyframes(), kFirst + kSaved);
}

TEST_F(SavedKeyframes, ThoseOfTwoMapsAreKeyframesOfOne) {
  constexpr std::uint64_t kFirst = 100;
  const auto both = merge_maps(bytes, bytes, kFirst);
  ASSERT_TRUE(both) << both.error();
  std::vector<KeyframePose> of_both = poses;
  for (const KeyframePose& p : poses) of_both.push_back({p.id + kFirst, p.stamp_ns, p.map_from_camera});
  LoopCloser closer;
  const auto read = closer.start_from(*both, of_both);
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(closer.keyframes(), 2 * kSaved);
  EXPECT_EQ(closer.to_bytes(), *both);
  EXPECT_EQ(merge_maps(bytes, LoopCloser().to_bytes(), kFirst).value(), bytes);
  EXPECT_FALSE(merge_maps(bytes, std::span(bytes).first(bytes.size() / 2), kFirst));
  EXPECT_FALSE(merge_maps(std::span(bytes).first(bytes.size() / 2), bytes, kFirst));
}

}  // namespace
}  // namespace rds::loop_closer
