// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/loops/returns.hpp"

#include <optional>
#include <vector>

#include "tools/evaluation/loops/loop_tolerance.hpp"

namespace rds::evaluation {
namespace {

using geometry::Pose;

constexpr double kNearM = 1;
constexpr double kNearRad = 0.52;
constexpr double kAwayM = 2;
constexpr double kAwayRad = 1.05;

struct KnownKeyframe {
  Pose truth = Pose::Identity();
  Pose map = Pose::Identity();
};

std::vector<KnownKeyframe> known_of(std::span<const geometry::StampedPose> keyframes,
                                    std::span<const geometry::StampedPose> truth) {
  std::vector<KnownKeyframe> known;
  for (const geometry::StampedPose& keyframe : keyframes)
    if (const auto pose = geometry::pose_at(truth, keyframe.stamp_ns, kMaxTruthGapNs))
      known.push_back({*pose, keyframe.map_from_camera});
  return known;
}

/// The nearest keyframe of an earlier stay near the last one.
const KnownKeyframe* earlier_stay(std::span<const KnownKeyframe> until_last) {
  const Pose camera_from_truth = until_last.back().truth.inverse();
  const KnownKeyframe* nearest = nullptr;
  double nearest_m = kNearM;
  bool was_away = false;
  for (auto k = until_last.rbegin(); k != until_last.rend(); ++k) {
    const Pose there = camera_from_truth * k->truth;
    was_away = was_away || !is_within(there, kAwayM, kAwayRad);
    if (!was_away || !is_within(there, nearest_m, kNearRad)) continue;
    nearest = &*k;
    nearest_m = there.translation().norm();
  }
  return nearest;
}

}  // namespace

ReturnScore score_returns(std::span<const geometry::StampedPose> keyframes,
                          std::span<const geometry::StampedPose> truth) {
  const std::vector<KnownKeyframe> known = known_of(keyframes, truth);
  ReturnScore score;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const KnownKeyframe* earlier = earlier_stay(std::span(known).first(i + 1));
    if (earlier == nullptr) continue;
    ++score.returned;
    if (!agree(earlier->map.inverse() * known[i].map, earlier->truth.inverse() * known[i].truth))
      ++score.missed;
  }
  return score;
}

}  // namespace rds::evaluation
