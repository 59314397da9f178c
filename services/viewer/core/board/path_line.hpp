// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "services/viewer/core/frames/frame.hpp"

namespace rds::viewer {

/// How much of the path a client has.
struct PathCursor {
  std::uint64_t generation = 0;
  std::size_t points = 0;
};

/// Where the camera was, as it was told live. Bounded: when it is full every second point goes.
class PathLine {
 public:
  static constexpr std::size_t kMostPoints = 20000;
  /// Nearer points than this are left out [m]: they cannot be told apart on a screen that shows a room.
  static constexpr float kStepM = 0.01F;

  void add(const Eigen::Vector3f& point_in_map);
  /// Another map, another path.
  void clear();

  /// The points that a client lacks; nullopt if none.
  [[nodiscard]] std::optional<Bytes> next(PathCursor& cursor) const;
  [[nodiscard]] std::size_t size() const { return points_.size(); }

 private:
  std::vector<Eigen::Vector3f> points_;
  std::uint64_t generation_ = 0;  // a new client has all of an empty path
};

}  // namespace rds::viewer
