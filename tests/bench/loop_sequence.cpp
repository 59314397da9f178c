// SPDX-License-Identifier: Apache-2.0
// Closes loops on a recording whose true poses were made to drift; prints the trajectory error before and
// after, and how far each verified pair of keyframes is from the truth.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/geometry/alignment.hpp"
#include "services/loop_closer/core/loop_closer.hpp"
#include "tests/bench/loop_keyframes.hpp"

namespace {

using rds::geometry::Pose;
using rds::loop_closer::Covisible;
using rds::loop_closer::KeyframeFeatures;
using rds::loop_closer::KeyframePose;

double ate_m(const std::vector<Pose>& truth, const std::vector<Pose>& estimate) {
  std::vector<Eigen::Vector3d> source;
  std::vector<Eigen::Vector3d> target;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    source.push_back(estimate[i].translation());
    target.push_back(truth[i].translation());
  }
  const Pose target_from_source = rds::geometry::align_rigid(source, target).target_from_source;
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    sum += (target_from_source * source[i] - target[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// The five keyframes before are covisible, as a tracker with a local map would have it.
std::vector<Covisible> neighbours(const std::vector<Pose>& poses, std::size_t index) {
  std::vector<Covisible> covisible;
  for (std::size_t back = 1; back <= std::min<std::size_t>(5, index); ++back)
    covisible.push_back({index - back, static_cast<std::uint32_t>(300 / back), poses[index - back]});
  return covisible;
}

/// What a tracker does with a correction: keyframes after it go on from the last corrected one.
std::vector<Pose> followed(const std::vector<Pose>& estimated, const std::vector<KeyframePose>& corrected) {
  std::vector<Pose> poses;
  for (const KeyframePose& pose : corrected) poses.push_back(pose.map_from_camera);
  const Pose moved = poses.back() * estimated[poses.size() - 1].inverse();
  for (std::size_t i = poses.size(); i < estimated.size(); ++i) poses.push_back(moved * estimated[i]);
  return poses;
}

/// With weight 0, as a tracker tells of all that a correction has moved.
void tell_all(const std::vector<Pose>& poses, KeyframeFeatures& features) {
  for (std::uint64_t id = 0; id < features.id; ++id)
    if (std::ranges::none_of(features.covisible, [&](const Covisible& c) { return c.id == id; }))
      features.covisible.push_back({id, 0, poses[id]});
}

void close_loops(const rds::bench::RecordedKeyframes& recorded, double drift_share, double turn_rad) {
  const auto drifted = rds::bench::drifted(recorded.truth, drift_share, turn_rad);
  std::vector<Pose> estimated = drifted;
  rds::loop_closer::LoopCloser closer;
  std::vector<double> times_ms;
  std::vector<double> closing_ms;
  for (std::size_t i = 0; i < recorded.keyframes.size(); ++i) {
    KeyframeFeatures features = recorded.keyframes[i];
    features.map_from_camera = estimated[i];
    features.covisible = neighbours(estimated, i);
    features.follows = true;
    tell_all(estimated, features);
    const auto start = std::chrono::steady_clock::now();
    const auto answer = closer.add(features);
    (answer.poses.empty() ? times_ms : closing_ms).push_back(milliseconds_since(start));
    if (answer.poses.empty()) continue;
    std::vector<Pose> corrected;
    for (const KeyframePose& pose : answer.poses) corrected.push_back(pose.map_from_camera);
    const std::vector<Pose> truth(recorded.truth.begin(),
                                  recorded.truth.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    const std::vector<Pose> before(estimated.begin(), estimated.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    fmt::print("loop at keyframe {}: ATE {:.3f} -> {:.3f} m ({:.0f} ms)\n", i, ate_m(truth, before),
               ate_m(truth, corrected), closing_ms.back());
    estimated = followed(estimated, answer.poses);
  }
  std::vector<Pose> corrected;
  for (const KeyframePose& pose : closer.poses()) corrected.push_back(pose.map_from_camera);
  std::sort(times_ms.begin(), times_ms.end());
  fmt::print("{} keyframes, {} loops, ATE {:.3f} -> {:.3f} m, without loop median {:.2f} p99 {:.2f} ms\n",
             corrected.size(), closer.revision(), ate_m(recorded.truth, drifted),
             ate_m(recorded.truth, corrected), times_ms[times_ms.size() / 2],
             times_ms[times_ms.size() * 99 / 100]);
}

rds::loop_closer::KeyframeView view_of(const KeyframeFeatures& features) {
  rds::loop_closer::KeyframeView view;
  for (std::size_t i = 0; i < features.points.size(); ++i) {
    if (!features.points[i].allFinite()) continue;
    view.points.push_back(features.points[i].cast<double>());
    view.descriptors.push_back(features.descriptors.row(static_cast<int>(i)));
  }
  return view;
}

/// Verifies all pairs at least ten keyframes apart.
void verify_pairs(const rds::bench::RecordedKeyframes& recorded, bool list) {
  std::vector<rds::loop_closer::KeyframeView> views;
  for (const auto& keyframe : recorded.keyframes) views.push_back(view_of(keyframe));
  std::vector<double> errors_m;
  int wrong = 0;
  for (std::size_t query = 0; query < views.size(); ++query) {
    for (std::size_t candidate = 0; candidate + 10 <= query; ++candidate) {
      const auto loop = verify_loop(views[query], views[candidate]);
      if (!loop) continue;
      const Pose error =
          loop->candidate_from_query.inverse() * recorded.truth[candidate].inverse() * recorded.truth[query];
      const double turned = rds::geometry::rotation_angle_rad(error.linear());
      errors_m.push_back(error.translation().norm());
      wrong += errors_m.back() > 0.15 || turned > 0.09 ? 1 : 0;
      if (list)
        fmt::print("{} {} inliers {} share {:.2f} error {:.3f} m {:.4f} rad\n", query, candidate,
                   loop->inliers, loop->inlier_share, errors_m.back(), turned);
    }
  }
  std::sort(errors_m.begin(), errors_m.end());
  if (errors_m.empty()) return;
  fmt::print(
      "{} pairs verified, error median {:.3f} p95 {:.3f} max {:.3f} m; {} off by more than 0.15 m or 5 "
      "degrees\n",
      errors_m.size(), errors_m[errors_m.size() / 2], errors_m[errors_m.size() * 95 / 100], errors_m.back(),
      wrong);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Loop closing on a recording with made drift"};
  std::string folder;
  std::size_t every = 6;
  double drift_share = 0.03;
  double turn_rad = 0.02;
  bool pairs = false;
  bool list = false;
  app.add_option("DATASET", folder, "TUM RGB-D folder with ground truth")->required();
  app.add_option("--every", every, "one keyframe in so many frames")->check(CLI::PositiveNumber);
  app.add_option("--drift", drift_share, "metres of drift per metre");
  app.add_option("--turn", turn_rad, "radians of drift per metre");
  app.add_flag("--pairs", pairs, "verify all pairs of keyframes instead");
  app.add_flag("--list", list, "with --pairs: print every pair");
  CLI11_PARSE(app, argc, argv);
  const auto recorded = rds::bench::read_keyframes(folder, every);
  if (!recorded) {
    std::cerr << recorded.error() << '\n';
    return 2;
  }
  if (pairs)
    verify_pairs(*recorded, list);
  else
    close_loops(*recorded, drift_share, turn_rad);
  return 0;
}
