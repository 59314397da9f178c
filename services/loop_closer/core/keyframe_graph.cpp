// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/keyframe_graph.hpp"

#include <algorithm>
#include <utility>

namespace rds::loop_closer {
namespace {

using geometry::Pose;

constexpr std::size_t kRecent =
    10;  // newest keyframes whose poses follow the tracker between two corrections
constexpr int kMaxCovisibleEdges = 5;           // per keyframe
constexpr std::uint32_t kMinSharedPoints = 50;  // of a covisibility edge
constexpr double kMaxLoopResidualM = 0.10;      // a loop edge that stays worse after optimisation was wrong
constexpr double kMaxLoopResidualRad = 0.05;

}  // namespace

std::optional<std::size_t> KeyframeGraph::find(std::uint64_t id) const {
  const auto found = index_of_id_.find(id);
  return found == index_of_id_.end() ? std::nullopt : std::optional(found->second);
}

void KeyframeGraph::hold(std::span<const KeyframePose> poses) {
  for (const KeyframePose& pose : poses) {
    index_of_id_[pose.id] = keyframes_.size();
    keyframes_.push_back(pose);
    corrected_.push_back(pose.map_from_camera);
  }
  held_ = keyframes_.size();
}

void KeyframeGraph::add(const KeyframePose& pose, std::span<const Covisible> covisible, bool follows) {
  const std::size_t newest = keyframes_.size();
  index_of_id_[pose.id] = newest;
  const Pose from_previous =
      newest == 0 ? Pose::Identity() : keyframes_.back().map_from_camera.inverse() * pose.map_from_camera;
  corrected_.push_back(newest == 0 ? pose.map_from_camera : corrected_.back() * from_previous);
  keyframes_.push_back(pose);
  Snapshot snapshot{{newest, pose.map_from_camera}};
  for (const Covisible& other : covisible)
    if (const auto index = find(other.id)) snapshot[*index] = other.map_from_camera;
  snapshot[newest] = pose.map_from_camera;
  add_edges(newest, covisible);
  if (follows) follow(snapshot);
  take(snapshot);
}

/// What the newest keyframe hangs on: the one before it, but at the end of a saved map the one it shares most
/// with.
std::size_t KeyframeGraph::predecessor(std::size_t newest, std::span<const Covisible> covisible) const {
  const auto known = [&](const Covisible& other) { return find(other.id).has_value(); };
  const auto best = std::ranges::find_if(covisible, known);
  return newest == held_ && best != covisible.end() ? *find(best->id) : newest - 1;
}

void KeyframeGraph::add_edges(std::size_t newest, std::span<const Covisible> covisible) {
  if (newest == 0) return;
  const Pose& pose = keyframes_[newest].map_from_camera;
  const std::size_t before = predecessor(newest, covisible);
  const Pose& previous = keyframes_[before].map_from_camera;
  edges_.push_back({before, newest, previous.inverse() * pose, EdgeKind::kOdometry});
  int added = 0;
  for (const Covisible& other : covisible) {
    const auto index = find(other.id);
    if (!index || *index == before || other.weight < kMinSharedPoints) continue;
    if (added++ == kMaxCovisibleEdges) break;
    edges_.push_back({*index, newest, other.map_from_camera.inverse() * pose, EdgeKind::kCovisible});
  }
}

/// The tracker has joined what the loops said: from here on its poses are the better measurement of them.
void KeyframeGraph::follow(const Snapshot& snapshot) {
  for (PoseGraphEdge& edge : edges_)
    if (edge.kind == EdgeKind::kLoop && snapshot.contains(edge.from) && snapshot.contains(edge.to))
      edge.kind = EdgeKind::kCovisible;
  for (const auto& [index, pose] : snapshot)
    if (index >= held_) corrected_[index] = pose;
}

void KeyframeGraph::take(const Snapshot& snapshot) {
  for (PoseGraphEdge& edge : edges_) {
    if (edge.kind == EdgeKind::kLoop) continue;
    const auto from = snapshot.find(edge.from);
    const auto to = snapshot.find(edge.to);
    if (from != snapshot.end() && to != snapshot.end())
      edge.from_from_to = from->second.inverse() * to->second;
  }
  const std::size_t first_recent = keyframes_.size() > kRecent ? keyframes_.size() - kRecent : 0;
  const auto anchor = snapshot.lower_bound(first_recent);
  for (const auto& [index, pose] : snapshot) {
    if (index < held_) continue;
    keyframes_[index].map_from_camera = pose;
    if (!is_corrected_)
      corrected_[index] = pose;
    else if (anchor != snapshot.end() && index > anchor->first)
      corrected_[index] = corrected_[anchor->first] * anchor->second.inverse() * pose;
  }
}

bool KeyframeGraph::close(std::span<const PoseGraphEdge> loops) {
  std::vector<Pose> optimized = corrected_;
  std::vector<PoseGraphEdge> edges = edges_;
  edges.insert(edges.end(), loops.begin(), loops.end());
  if (!optimize_pose_graph(optimized, edges, std::max<std::size_t>(1, held_))) return false;
  const bool satisfied = std::all_of(loops.begin(), loops.end(), [&](const PoseGraphEdge& loop) {
    const EdgeResidual residual = residual_of(loop, optimized);
    return residual.translation_m <= kMaxLoopResidualM && residual.rotation_rad <= kMaxLoopResidualRad;
  });
  if (!satisfied) return false;
  corrected_ = std::move(optimized);
  edges_ = std::move(edges);
  is_corrected_ = true;
  return true;
}

void KeyframeGraph::take_back() {
  std::erase_if(edges_, [](const PoseGraphEdge& edge) { return edge.kind == EdgeKind::kLoop; });
  for (std::size_t i = held_; i < keyframes_.size(); ++i) corrected_[i] = keyframes_[i].map_from_camera;
}

std::vector<KeyframePose> KeyframeGraph::poses() const {
  std::vector<KeyframePose> poses;
  for (std::size_t i = held_; i < keyframes_.size(); ++i)
    poses.push_back({keyframes_[i].id, keyframes_[i].stamp_ns, corrected_[i]});
  return poses;
}

double KeyframeGraph::path_length(std::size_t from, std::size_t to) const {
  double length = 0;
  for (std::size_t i = std::min(from, to); i < std::max(from, to); ++i)
    length += (corrected_[i + 1].translation() - corrected_[i].translation()).norm();
  return length;
}

}  // namespace rds::loop_closer
