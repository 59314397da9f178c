// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "services/loop_closer/core/loop_types.hpp"
#include "services/loop_closer/core/pose_graph.hpp"

namespace rds::loop_closer {

/// All keyframes of an epoch, their corrected poses, and the relative poses between them.
///
/// Two sources must not fight: the tracker's bundle adjustment knows best how keyframes that share points
/// stand to each other, the loop closer how those do that do not yet. So edges between neighbours are always
/// the relative poses of one snapshot of the tracker (its frame cancels out, whether it has followed a
/// correction yet or not) and are replaced whenever a newer snapshot holds both ends. Once the tracker has
/// followed the last correction its points join both sides of the loop: then its absolute poses count, too,
/// and the edge of a loop is one like others.
class KeyframeGraph {
 public:
  /// Starts with keyframes of a saved map, by ascending id: the gauge, which nothing moves. @pre the graph is
  /// empty.
  void hold(std::span<const KeyframePose> poses);

  /// Adds the newest keyframe. `covisible` and `pose` are one snapshot; most shared map points first.
  /// The previous keyframe should be in it (with any weight): else its last known pose stands in.
  /// @param follows  the snapshot contains the last correction.
  void add(const KeyframePose& pose, std::span<const Covisible> covisible, bool follows = false);

  /// Adds loop edges and optimises. If the poses then do not satisfy them, everything is as before and the
  /// answer false.
  bool close(std::span<const PoseGraphEdge> loops);
  /// The tracker has not followed the last correction: the loops that it has not joined go, and its poses
  /// count.
  void take_back();

  [[nodiscard]] std::size_t size() const { return keyframes_.size(); }
  [[nodiscard]] std::optional<std::size_t> find(std::uint64_t id) const;
  [[nodiscard]] std::uint64_t id(std::size_t index) const { return keyframes_[index].id; }
  [[nodiscard]] const geometry::Pose& map_from_camera(std::size_t index) const { return corrected_[index]; }
  /// Of all keyframes but those held.
  [[nodiscard]] std::vector<KeyframePose> poses() const;
  /// Travelled between two keyframes [m], along the corrected poses.
  [[nodiscard]] double path_length(std::size_t from, std::size_t to) const;

 private:
  using Snapshot = std::map<std::size_t, geometry::Pose>;  // by place in keyframes_

  void add_edges(std::size_t newest, std::span<const Covisible> covisible);
  [[nodiscard]] std::size_t predecessor(std::size_t newest, std::span<const Covisible> covisible) const;
  void follow(const Snapshot& snapshot);
  void take(const Snapshot& snapshot);

  std::vector<KeyframePose> keyframes_;    // as the tracker last told
  std::vector<geometry::Pose> corrected_;  // map_from_camera after the loops closed so far
  std::map<std::uint64_t, std::size_t> index_of_id_;
  std::vector<PoseGraphEdge> edges_;
  std::size_t held_ = 0;
  bool is_corrected_ = false;
};

}  // namespace rds::loop_closer
