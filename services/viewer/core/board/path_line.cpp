// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/board/path_line.hpp"

namespace rds::viewer {

void PathLine::add(const Eigen::Vector3f& point_in_map) {
  if (!point_in_map.allFinite()) return;
  if (!points_.empty() && (points_.back() - point_in_map).norm() < kStepM) return;
  if (points_.size() >= kMostPoints) {
    for (std::size_t i = 0; 2 * i < points_.size(); ++i) points_[i] = points_[2 * i];
    points_.resize((points_.size() + 1) / 2);
    ++generation_;
  }
  points_.push_back(point_in_map);
}

void PathLine::clear() {
  points_.clear();
  ++generation_;
}

std::optional<Bytes> PathLine::next(PathCursor& cursor) const {
  const bool is_other = cursor.generation != generation_;
  if (!is_other && cursor.points == points_.size()) return std::nullopt;
  const std::size_t first = is_other ? 0 : cursor.points;
  cursor = {generation_, points_.size()};
  auto frame = begin_frame(Kind::kPath);
  frame.put(static_cast<std::uint32_t>(first));
  frame.put(static_cast<std::uint32_t>(points_.size() - first));
  for (std::size_t i = first; i < points_.size(); ++i)
    for (const float value : points_[i]) frame.put(value);
  return frame.take();
}

}  // namespace rds::viewer
