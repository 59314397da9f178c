// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/relocalization/place_vote.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <Eigen/Geometry>

namespace rds::tracker {
namespace {

constexpr int kMaxDistance = 60;      // bits in which descriptors that look alike differ at most
constexpr double kMaxHeightM = 0.25;  // by which the frames' heights differ at most
constexpr double kCellM = 0.2;        // of the votes
constexpr float kCellsPerM = 1 / static_cast<float>(kCellM);
constexpr int kTurns = 120;  // around the vertical: 3 degrees each
constexpr std::size_t kPeaks = 4;
constexpr float kShareOfMost = 0.5;
constexpr int kApartCells = 3;  // peaks that are nearer are one …
constexpr int kApartTurns = 4;
constexpr std::size_t kMinMet = 10;

using geometry::Pose;

double turn_of(int index) {
  return 2 * std::numbers::pi * index / kTurns;
}

/// Votes for shifts over the ground, for each turn.
class Votes {
 public:
  explicit Votes(double radius_m)
      : half_(static_cast<int>(std::ceil(radius_m / kCellM)) + 1),
        size_(2 * half_ + 1),
        counts_(static_cast<std::size_t>(kTurns * size_ * size_)) {}

  void add(int turn, const Eigen::Vector2f& shift, float votes) {
    const int x = static_cast<int>(std::floor(shift.x() * kCellsPerM)) + half_;
    const int y = static_cast<int>(std::floor(shift.y() * kCellsPerM)) + half_;
    if (x >= 0 && y >= 0 && x < size_ && y < size_) counts_[index(turn, x, y)] += votes;
  }

  struct Peak {
    int turn = 0;
    int x = 0;
    int y = 0;
    float votes = 0;
  };

  /// Where the sums of four cells that share a corner are largest, the largest first, none beside another
  /// one.
  [[nodiscard]] std::vector<Peak> peaks(double radius_m) const {
    float most = 0;
    for_each_sum(radius_m, [&](const Peak& p) { most = std::max(most, p.votes); });
    std::vector<Peak> high;
    for_each_sum(radius_m, [&](const Peak& p) {
      if (p.votes > 0 && p.votes >= kShareOfMost * most) high.push_back(p);
    });
    std::ranges::stable_sort(high, std::greater<>{}, &Peak::votes);
    std::vector<Peak> chosen;
    for (const Peak& p : high) {
      if (std::ranges::none_of(chosen, [&](const Peak& c) { return are_one(p, c); })) chosen.push_back(p);
      if (chosen.size() == kPeaks) break;
    }
    return chosen;
  }

  [[nodiscard]] Eigen::Vector2d shift_of(const Peak& p) const {
    return {(p.x - half_) * kCellM, (p.y - half_) * kCellM};
  }

 private:
  template <class Visit>
  void for_each_sum(double radius_m, const Visit& visit) const {
    for (int t = 0; t < kTurns; ++t)
      for (int y = 1; y < size_; ++y)
        for (int x = 1; x < size_; ++x)
          if (shift_of({t, x, y}).squaredNorm() <= radius_m * radius_m)
            visit(Peak{t, x, y,
                       counts_[index(t, x, y)] + counts_[index(t, x - 1, y)] + counts_[index(t, x, y - 1)] +
                           counts_[index(t, x - 1, y - 1)]});
  }
  static bool are_one(const Peak& a, const Peak& b) {
    const int turns = std::abs(a.turn - b.turn);
    return std::abs(a.x - b.x) <= kApartCells && std::abs(a.y - b.y) <= kApartCells &&
           std::min(turns, kTurns - turns) <= kApartTurns;
  }
  [[nodiscard]] std::size_t index(int turn, int x, int y) const {
    return static_cast<std::size_t>((turn * size_ + y) * size_ + x);
  }

  int half_;
  int size_;
  std::vector<float> counts_;
};

/// Side by side in memory: each feature is compared with thousands.
struct Candidate {
  double height = 0;
  std::size_t index = 0;
  Descriptor descriptor{};
};

std::vector<Candidate> by_height(std::span<const PlacedFeature> features) {
  std::vector<Candidate> sorted;
  sorted.reserve(features.size());
  for (std::size_t i = 0; i < features.size(); ++i)
    sorted.push_back({features[i].position.z(), i, *features[i].descriptor});
  std::ranges::stable_sort(sorted, {}, &Candidate::height);
  return sorted;
}

Pose pose_of(double turn_rad, const Eigen::Vector2d& shift, const VoteWindow& window) {
  const Eigen::AngleAxisd turn(turn_rad, Eigen::Vector3d::UnitZ());
  Eigen::Vector3d place = window.point_there;
  place.head<2>() += shift;
  return geometry::make_pose(place - turn * window.point_here, Eigen::Quaterniond(turn));
}

/// A pair's: where its features stand from the window's two points, over the ground, and its share of a vote.
struct Ballot {
  Eigen::Vector2f at = Eigen::Vector2f::Zero();
  Eigen::Vector2f from = Eigen::Vector2f::Zero();
  float share = 0;
};

std::vector<Ballot> ballots_of(std::span<const PlacedFeature> here, std::span<const PlacedFeature> there,
                               std::span<const AlikePair> pairs, const VoteWindow& window) {
  std::vector<float> alike(here.size());
  for (const AlikePair& p : pairs) alike[p.here] += 1;
  std::vector<Ballot> ballots;
  ballots.reserve(pairs.size());
  for (const AlikePair& p : pairs)
    ballots.push_back({(there[p.there].position - window.point_there).head<2>().cast<float>(),
                       (here[p.here].position - window.point_here).head<2>().cast<float>(),
                       1 / alike[p.here]});
  return ballots;
}

}  // namespace

std::vector<AlikePair> alike_pairs(std::span<const PlacedFeature> here, std::span<const PlacedFeature> there,
                                   const VoteWindow& window) {
  const double higher = window.point_there.z() - window.point_here.z();
  const std::vector<Candidate> candidates = by_height(there);
  std::vector<AlikePair> pairs;
  for (std::size_t i = 0; i < here.size(); ++i) {
    const double z = here[i].position.z() + higher;
    for (auto c = std::ranges::lower_bound(candidates, z - kMaxHeightM, {}, &Candidate::height);
         c != candidates.end() && c->height < z + kMaxHeightM; ++c)
      if (descriptor_distance(*here[i].descriptor, c->descriptor) <= kMaxDistance)
        pairs.push_back({i, c->index});
  }
  return pairs;
}

std::vector<VotedPose> vote_for_poses(std::span<const PlacedFeature> here,
                                      std::span<const PlacedFeature> there, std::span<const AlikePair> pairs,
                                      const VoteWindow& window) {
  const std::vector<Ballot> ballots = ballots_of(here, there, pairs, window);
  Votes votes(window.radius_m);
  for (int t = 0; t < kTurns; ++t) {
    const Eigen::Rotation2Df turn(static_cast<float>(turn_of(t)));
    for (const Ballot& b : ballots) votes.add(t, b.at - turn * b.from, b.share);
  }
  std::vector<VotedPose> poses;
  for (const auto& peak : votes.peaks(window.radius_m))
    poses.push_back({pose_of(turn_of(peak.turn), votes.shift_of(peak), window), peak.votes});
  return poses;
}

std::vector<std::size_t> align_alike(std::span<const PlacedFeature> here,
                                     std::span<const PlacedFeature> there, std::span<const AlikePair> pairs,
                                     Pose& there_from_here) {
  std::vector<std::size_t> met;
  for (const double radius_m : {0.4, 0.25, 0.15, 0.1}) {
    std::vector<double> nearest(here.size(), radius_m);
    std::vector<std::size_t> partner(here.size(), there.size());
    for (const AlikePair& p : pairs) {
      const double apart = (there_from_here * here[p.here].position - there[p.there].position).norm();
      if (apart >= nearest[p.here]) continue;
      nearest[p.here] = apart;
      partner[p.here] = p.there;
    }
    met.clear();
    Eigen::Matrix3Xd from(3, here.size());
    Eigen::Matrix3Xd to(3, here.size());
    for (std::size_t i = 0; i < here.size(); ++i) {
      if (partner[i] == there.size()) continue;
      from.col(static_cast<Eigen::Index>(met.size())) = here[i].position;
      to.col(static_cast<Eigen::Index>(met.size())) = there[partner[i]].position;
      met.push_back(partner[i]);
    }
    if (met.size() < kMinMet) return {};
    const auto n = static_cast<Eigen::Index>(met.size());
    there_from_here = Pose(Eigen::umeyama(from.leftCols(n), to.leftCols(n), false));
  }
  return met;
}

}  // namespace rds::tracker
