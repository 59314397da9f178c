// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/loop_closer.hpp"

#include <limits>

#include <gmock/gmock.h>

#include "tests/unit/services/loop_closer/core/synthetic_places.hpp"

namespace rds::loop_closer {
namespace {

using geometry::Pose;

constexpr double kStep = 0.2;  // radians between keyframes

/// A camera turns once around in a round room and a little farther, while its pose drifts.
class TurningCamera {
 public:
  explicit TurningCamera(double drift_m = 0.012) : drift_(0.3 * drift_m, drift_m, 0) {}

  KeyframeFeatures next() {
    const Pose truth = looking_out(kStep * static_cast<double>(truth_.size()));
    Pose estimate = truth;
    if (!truth_.empty()) {
      Pose step = truth_.back().inverse() * truth;
      step.translation() += drift_;
      estimate = estimate_.back() * step;
    }
    KeyframeFeatures features = world_.seen_from(truth, truth_.size());
    features.map_epoch = epoch;
    features.id = truth_.size();
    features.stamp_ns = static_cast<std::int64_t>(truth_.size()) * 100'000'000;
    features.map_from_camera = estimate;
    for (std::size_t back = 1; back <= std::min<std::size_t>(3, truth_.size()); ++back)
      features.covisible.push_back({truth_.size() - back, 200, estimate_[truth_.size() - back]});
    truth_.push_back(truth);
    estimate_.push_back(estimate);
    return features;
  }

  [[nodiscard]] double error_m(const std::vector<KeyframePose>& poses) const {
    double sum = 0;
    for (std::size_t i = 0; i < poses.size(); ++i)
      sum += (poses[i].map_from_camera.translation() - truth_[i].translation()).norm();
    return sum / static_cast<double>(poses.size());
  }

  std::uint64_t epoch = 7;

 private:
  SyntheticWorld world_ = SyntheticWorld::round_room(1500, 1);
  Eigen::Vector3d drift_;
  std::vector<Pose> truth_;
  std::vector<Pose> estimate_;
};

TEST(LoopCloser, AnswersEveryKeyframeAndClosesTheCircle) {
  TurningCamera camera;
  LoopCloser closer;
  double before = 0;
  double after = 0;
  for (int i = 0; i < 38; ++i) {
    const auto features = camera.next();
    const auto old_poses = closer.poses();
    const auto answer = closer.add(features);
    EXPECT_EQ(answer.keyframe_id, features.id);
    EXPECT_EQ(answer.refused, "");
    EXPECT_EQ(answer.revision, closer.revision());
    EXPECT_EQ(answer.loops_closed, answer.revision);
    if (answer.poses.empty()) continue;
    EXPECT_EQ(answer.poses.size(), features.id + 1);
    if (before > 0) continue;
    before = camera.error_m(old_poses);
    after = camera.error_m(answer.poses);
  }
  EXPECT_GE(closer.revision(), 1U);
  EXPECT_GT(before, 0.1);
  EXPECT_LT(after, 0.4 * before);
}

TEST(LoopCloser, TellsWhatSeesTheSamePlaceWhereTheMapIsRight) {
  TurningCamera camera(0.0);
  LoopCloser closer;
  std::vector<LoopMatch> loops;
  for (int i = 0; i < 38 && loops.empty(); ++i) loops = closer.add(camera.next()).loops;
  ASSERT_FALSE(loops.empty());
  for (const LoopMatch& loop : loops) {
    EXPECT_GE(loop.later, loop.earlier + 10);
    const Pose truth = looking_out(kStep * static_cast<double>(loop.earlier)).inverse() *
                       looking_out(kStep * static_cast<double>(loop.later));
    EXPECT_LT((truth.inverse() * loop.earlier_from_later).translation().norm(), 0.02);
  }
  EXPECT_LT(camera.error_m(closer.poses()), 0.01);
}

/// A tracker that follows makes the last keyframes covisible with the first ones: nothing is told twice.
TEST(LoopCloser, TakesThePosesOfATrackerThatHasFollowed) {
  TurningCamera camera;
  LoopCloser closer;
  LoopAnswer closed;
  while (closed.loops.empty()) closed = closer.add(camera.next());
  KeyframeFeatures next = camera.next();
  next.follows = true;
  next.covisible.clear();
  const Eigen::Translation3d adjusted(0.004, 0, 0);
  for (const KeyframePose& pose : closed.poses)
    next.covisible.push_back({pose.id, pose.id < 3 ? 50U : 0U, adjusted * pose.map_from_camera});
  EXPECT_EQ(closer.add(next).refused, "");
  for (std::size_t i = 0; i < closed.poses.size(); ++i)
    EXPECT_TRUE(
        closer.poses()[i].map_from_camera.isApprox(adjusted * closed.poses[i].map_from_camera, 1e-12));
}

TEST(LoopCloser, LooksAtNothingThatMoves) {
  TurningCamera camera;
  LoopCloser closer;
  for (int i = 0; i < 38; ++i) {
    auto features = camera.next();
    features.movable.assign(features.points.size(), 1);
    EXPECT_TRUE(closer.add(features).poses.empty());
  }
}

TEST(LoopCloser, LeavesCovisibleKeyframesToTheTracker) {
  TurningCamera camera;
  LoopCloser closer;
  for (int i = 0; i < 38; ++i) {
    auto features = camera.next();
    for (const auto& pose : closer.poses()) features.covisible.push_back({pose.id, 1, pose.map_from_camera});
    EXPECT_TRUE(closer.add(features).poses.empty());
  }
}

TEST(LoopCloser, GivesTheSameBytesEveryTime) {
  const auto run = [] {
    TurningCamera camera;
    LoopCloser closer;
    for (int i = 0; i < 36; ++i) closer.add(camera.next());
    return closer.poses();
  };
  const auto first = run();
  const auto second = run();
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i)
    EXPECT_EQ(first[i].map_from_camera.matrix(), second[i].map_from_camera.matrix());
}

TEST(LoopCloser, StartsAnewWithAnotherEpoch) {
  TurningCamera camera;
  LoopCloser closer;
  for (int i = 0; i < 36; ++i) closer.add(camera.next());
  ASSERT_GE(closer.revision(), 1U);
  TurningCamera restarted;
  restarted.epoch = 8;
  const auto answer = closer.add(restarted.next());
  EXPECT_EQ(answer.map_epoch, 8U);
  EXPECT_EQ(answer.revision, 0U);
  EXPECT_EQ(closer.poses().size(), 1U);
}

TEST(LoopCloser, RefusesImpossibleKeyframesAndStaysAsItWas) {
  TurningCamera camera;
  LoopCloser closer;
  const auto good = camera.next();
  closer.add(good);
  auto next = camera.next();
  const auto refused = [&](auto change) {
    auto features = next;
    change(features);
    return closer.add(features).refused;
  };
  EXPECT_NE(refused([](auto& f) { f.points.pop_back(); }), "");
  EXPECT_NE(refused([](auto& f) { f.movable.pop_back(); }), "");
  EXPECT_NE(refused([](auto& f) { f.descriptors = cv::Mat::zeros(f.descriptors.rows, 31, CV_8U); }), "");
  EXPECT_NE(refused([](auto& f) { f.map_from_camera.translation().x() = std::nan(""); }), "");
  EXPECT_NE(refused([](auto& f) { f.map_from_camera.linear() *= 2; }), "");
  EXPECT_NE(refused([](auto& f) { f.covisible[0].map_from_camera.linear().setZero(); }), "");
  EXPECT_NE(refused([&](auto& f) { f.id = good.id; }), "");
  EXPECT_EQ(closer.poses().size(), 1U);
  EXPECT_EQ(closer.add(next).refused, "");
}

TEST(LoopCloser, IgnoresPointsThatNoCameraSees) {
  TurningCamera camera;
  LoopCloser closer;
  const float huge = std::numeric_limits<float>::max();
  const std::vector<Eigen::Vector3f> impossible{
      {std::nanf(""), 0, 1}, {0, 0, -2}, {huge, huge, 1}, {0, 0, huge}, {0, 0, 0}};
  for (int i = 0; i < 38; ++i) {
    auto features = camera.next();
    for (std::size_t p = 0; p < features.points.size(); ++p)
      features.points[p] = impossible[p % impossible.size()];
    const auto answer = closer.add(features);
    EXPECT_EQ(answer.refused, "");
    EXPECT_TRUE(answer.poses.empty());
  }
}

TEST(LoopCloser, TakesKeyframesWithoutFeatures) {
  LoopCloser closer;
  for (std::uint64_t id = 0; id < 15; ++id) {
    KeyframeFeatures empty;
    empty.id = id;
    EXPECT_EQ(closer.add(empty).refused, "");
  }
}

}  // namespace
}  // namespace rds::loop_closer
