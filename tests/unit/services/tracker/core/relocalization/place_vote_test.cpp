// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/relocalization/place_vote.hpp"

#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace rds::tracker {
namespace {

/// Features of a room, and of the floor around it, in which each of them looks like many others.
class PlaceVote : public testing::Test {
 protected:
  static constexpr std::size_t kSeen = 120;
  static constexpr int kPatterns = 30;
  static constexpr int kOthers = 1500;
  static constexpr int kFlippedBits = 20;

  PlaceVote() {
    for (int p = 0; p < kPatterns; ++p) {
      Descriptor descriptor;
      for (auto& byte : descriptor) byte = static_cast<std::uint8_t>(random());
      patterns.push_back(descriptor);
    }
    for (std::size_t i = 0; i < kSeen; ++i) {
      const std::size_t pattern = i % kPatterns;
      const Eigen::Vector3d seen(between(-2, 2), between(-2, 2), between(0, 2));
      here_looks.push_back(like(pattern));
      there_looks.push_back(like(pattern));
      here_at.push_back(seen);
      there_at.push_back(truth * seen + Eigen::Vector3d(off(), off(), off()));
    }
    for (int i = 0; i < kOthers; ++i) {
      there_looks.push_back(like(random() % kPatterns));
      there_at.emplace_back(between(-8, 12), between(-8, 12), between(0, 2));
    }
  }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
  double off() { return std::normal_distribution<double>(0, 0.02)(random); }
  Descriptor like(std::size_t pattern) {
    Descriptor descriptor = patterns[pattern];
    for (int b = 0; b < kFlippedBits; ++b) {
      const auto bit = random() % 256;
      descriptor[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    }
    return descriptor;
  }
  static std::vector<PlacedFeature> placed(const std::vector<Eigen::Vector3d>& at,
                                           const std::vector<Descriptor>& looks) {
    std::vector<PlacedFeature> all;
    for (std::size_t i = 0; i < at.size(); ++i) all.push_back({at[i], &looks[i]});
    return all;
  }
  [[nodiscard]] std::vector<PlacedFeature> here() const { return placed(here_at, here_looks); }
  [[nodiscard]] std::vector<PlacedFeature> there() const { return placed(there_at, there_looks); }

  std::mt19937 random{5};
  geometry::Pose truth =
      geometry::make_pose({3, 1, 0.1}, Eigen::Quaterniond(Eigen::AngleAxisd(2.1, Eigen::Vector3d::UnitZ())));
  VoteWindow window{{0, 0, 0}, {2, 0, 0.1}, 2};  // the truth has that point at (3, 1)
  std::vector<Descriptor> patterns, here_looks, there_looks;
  std::vector<Eigen::Vector3d> here_at, there_at;
};

TEST_F(PlaceVote, TellsThePlaceWhereEachFeatureLooksLikeFiftyOthers) {
  const auto pairs = alike_pairs(here(), there(), window);
  EXPECT_GT(pairs.size(), 10 * kSeen);
  const auto voted = vote_for_poses(here(), there(), pairs, window);
  ASSERT_FALSE(voted.empty());
  for (std::size_t i = 1; i < voted.size(); ++i) EXPECT_LE(voted[i].votes, voted[i - 1].votes);
  const geometry::Pose rough = truth.inverse() * voted.front().there_from_here;
  EXPECT_LT(rough.translation().norm(), 0.3);
  EXPECT_LT(geometry::rotation_angle_rad(rough.linear()), 0.06);

  geometry::Pose laid = voted.front().there_from_here;
  const auto met = align_alike(here(), there(), pairs, laid);
  EXPECT_GT(met.size(), 8 * kSeen / 10);
  EXPECT_LT((truth.inverse() * laid).translation().norm(), 0.02);
  EXPECT_LT(geometry::rotation_angle_rad((truth.inverse() * laid).linear()), 0.01);
}

TEST_F(PlaceVote, LooksNowhereElse) {
  window.point_there = {1, -2, 0.1};  // 3.6 m from the truth
  const auto pairs = alike_pairs(here(), there(), window);
  for (const VotedPose& voted : vote_for_poses(here(), there(), pairs, window)) {
    const Eigen::Vector3d at = voted.there_from_here * window.point_here;
    EXPECT_LE((at - window.point_there).head<2>().norm(), window.radius_m + 1e-9);
    EXPECT_NEAR(at.z(), 0.1, 1e-9);
  }
}

TEST_F(PlaceVote, PairsStandAtTheSameHeight) {
  window.point_there.z() = 3;
  for (const AlikePair& p : alike_pairs(here(), there(), window))
    EXPECT_NEAR(there_at[p.there].z() - here_at[p.here].z(), 3, 0.25);
  window.point_there.z() = 5;
  const auto none = alike_pairs(here(), there(), window);
  EXPECT_TRUE(none.empty());
  EXPECT_TRUE(vote_for_poses(here(), there(), none, window).empty());
}

TEST_F(PlaceVote, FewThatMeetTellNothing) {
  const auto pairs = alike_pairs(here(), there(), window);
  geometry::Pose elsewhere = Eigen::Translation3d(100, 0, 0) * truth;
  EXPECT_TRUE(align_alike(here(), there(), pairs, elsewhere).empty());
}

}  // namespace
}  // namespace rds::tracker
