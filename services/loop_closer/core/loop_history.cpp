// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/loop_history.hpp"

#include <set>

namespace rds::loop_closer {

namespace {

constexpr std::size_t kMinDetections = 3;    // as Mur-Artal & Tardós 2017, …
constexpr std::size_t kWindowKeyframes = 6;  // … but half of the keyframes may find nothing
constexpr double kMaxDifferenceM = 0.10;     // a correction is measured to a few centimetres
constexpr double kMaxDifferenceRad = 0.05;

}  // namespace

bool is_consistent(const LoopDetection& a, const LoopDetection& b) {
  const geometry::Pose difference = a.correction.inverse() * b.correction;
  const double moved_m = (a.correction * b.query_in_map - b.correction * b.query_in_map).norm();
  return moved_m <= kMaxDifferenceM &&
         geometry::rotation_angle_rad(difference.linear()) <= kMaxDifferenceRad;
}

std::vector<LoopDetection> LoopHistory::add(const LoopDetection& detection) {
  while (!detections_.empty() && detections_.front().query + kWindowKeyframes <= detection.query)
    detections_.pop_front();
  std::vector<LoopDetection> agreeing;
  std::set<std::size_t> queries{detection.query};
  for (const LoopDetection& earlier : detections_) {
    if (!is_consistent(detection, earlier)) continue;
    agreeing.push_back(earlier);
    queries.insert(earlier.query);
  }
  detections_.push_back(detection);
  agreeing.push_back(detection);
  if (queries.size() < kMinDetections) agreeing.clear();
  return agreeing;
}

}  // namespace rds::loop_closer
