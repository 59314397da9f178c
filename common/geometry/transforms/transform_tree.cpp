// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/transforms/transform_tree.hpp"

#include <algorithm>
#include <iterator>

namespace rds::geometry {
namespace {

using StampedPoses = std::deque<std::pair<std::int64_t, Pose>>;

/// @param after  one of `poses`, but not the first. @param stamp_ns  may lie beyond it.
Pose on_line_to(StampedPoses::const_iterator after, std::int64_t stamp_ns) {
  const auto& [first_ns, first] = *std::prev(after);
  const auto& [second_ns, second] = *after;
  const double share = static_cast<double>(stamp_ns - first_ns) / static_cast<double>(second_ns - first_ns);
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond(first.linear()).slerp(share, Eigen::Quaterniond(second.linear()));
  return make_pose((1 - share) * first.translation() + share * second.translation(), turn);
}

Pose beyond_last(const StampedPoses& poses, std::int64_t stamp_ns) {
  if (poses.size() == 1) return poses.back().second;
  const auto last = std::prev(poses.end());
  const std::int64_t interval_ns = last->first - std::prev(last)->first;
  if (interval_ns > TransformTree::kSteadyNs) return last->second;
  return on_line_to(last, std::min(stamp_ns, last->first + interval_ns));
}

Pose pose_at(const StampedPoses& poses, std::int64_t stamp_ns) {
  const auto after = std::ranges::lower_bound(poses, stamp_ns, {}, &StampedPoses::value_type::first);
  if (after == poses.begin()) return poses.front().second;
  if (after == poses.end()) return beyond_last(poses, stamp_ns);
  return on_line_to(after, stamp_ns);
}

}  // namespace

TransformTree::Edge* TransformTree::edge_for(const std::string& parent, const std::string& child) {
  if (parent.empty() || child.empty() || parent == child) return nullptr;
  if (!by_child_.contains(child) && by_child_.size() >= kMaxFrames) return nullptr;
  Edge& edge = by_child_[child];
  if (edge.parent != parent) edge = {parent, false, {}};
  return &edge;
}

void TransformTree::set(const std::string& parent, const std::string& child, std::int64_t stamp_ns,
                        const Pose& parent_from_child) {
  Edge* edge = edge_for(parent, child);
  if (edge == nullptr) return;
  if (edge->is_static) *edge = {parent, false, {}};
  auto& poses = edge->poses;
  // Stamps that go back are those of another time.
  while (!poses.empty() && poses.back().first >= stamp_ns) poses.pop_back();
  poses.emplace_back(stamp_ns, parent_from_child);
  while (poses.front().first < stamp_ns - kKeptNs) poses.pop_front();
}

void TransformTree::set_static(const std::string& parent, const std::string& child,
                               const Pose& parent_from_child) {
  Edge* edge = edge_for(parent, child);
  if (edge != nullptr) *edge = {parent, true, {{0, parent_from_child}}};
}

const TransformTree::Edge* TransformTree::edge_of(const std::string& frame, std::int64_t stamp_ns) const {
  const auto found = by_child_.find(frame);
  if (found == by_child_.end()) return nullptr;
  const Edge& edge = found->second;
  const bool is_forgotten = !edge.is_static && edge.poses.back().first < stamp_ns - kForgottenNs;
  return is_forgotten ? nullptr : &edge;
}

std::vector<std::string> TransformTree::ancestry(const std::string& frame, std::int64_t stamp_ns) const {
  std::vector<std::string> frames{frame};
  while (frames.size() < kDeepest) {
    const Edge* edge = edge_of(frames.back(), stamp_ns);
    if (edge == nullptr) break;
    frames.push_back(edge->parent);
  }
  return frames;
}

Pose TransformTree::root_from(const std::vector<std::string>& ancestry, std::int64_t stamp_ns) const {
  Pose pose = Pose::Identity();
  for (std::size_t i = 0; i + 1 < ancestry.size(); ++i)
    pose = pose_at(by_child_.at(ancestry[i]).poses, stamp_ns) * pose;
  return pose;
}

std::optional<Pose> TransformTree::lookup(const std::string& target, const std::string& source,
                                          std::int64_t stamp_ns) const {
  const auto of_target = ancestry(target, stamp_ns);
  const auto of_source = ancestry(source, stamp_ns);
  if (of_target.back() != of_source.back()) return std::nullopt;
  return root_from(of_target, stamp_ns).inverse() * root_from(of_source, stamp_ns);
}

}  // namespace rds::geometry
