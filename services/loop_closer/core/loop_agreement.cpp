// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/loop_agreement.hpp"

#include <algorithm>
#include <iterator>

namespace rds::loop_closer {

namespace {

constexpr double kMaxDifferenceM = 0.10;  // a correction is measured to a few centimetres
constexpr double kMaxDifferenceRad = 0.05;

}  // namespace

bool is_consistent(const LoopDetection& a, const LoopDetection& b) {
  const geometry::Pose difference = a.correction.inverse() * b.correction;
  const double moved_m = (a.correction * b.query_in_map - b.correction * b.query_in_map).norm();
  return moved_m <= kMaxDifferenceM &&
         geometry::rotation_angle_rad(difference.linear()) <= kMaxDifferenceRad;
}

std::vector<LoopDetection> most_that_agree(std::span<const LoopDetection> detections) {
  std::vector<LoopDetection> most;
  for (const LoopDetection& one : detections) {
    std::vector<LoopDetection> agreeing;
    std::ranges::copy_if(detections, std::back_inserter(agreeing),
                         [&](const LoopDetection& other) { return is_consistent(one, other); });
    if (agreeing.size() > most.size()) most = std::move(agreeing);
  }
  return most;
}

}  // namespace rds::loop_closer
