// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "common/geometry/camera_model.hpp"
#include "common/geometry/pose.hpp"
#include "tools/simulator/people/gait.hpp"
#include "tools/simulator/rendering/random.hpp"
#include "tools/simulator/world/floor_map.hpp"

namespace rds::simulator {

/// A person's movements over the whole recording.
class Walk {
 public:
  static constexpr double kStepS = 1.0 / 60;

  void push(const Motion& motion) { samples_.push_back(motion); }
  [[nodiscard]] bool empty() const { return samples_.empty(); }
  [[nodiscard]] double duration_s() const { return static_cast<double>(samples_.size()) * kStepS; }
  [[nodiscard]] const Motion& last() const { return samples_.back(); }
  [[nodiscard]] const std::vector<Motion>& samples() const { return samples_; }
  void append(const Walk& other);
  void truncate(std::size_t count) { samples_.resize(std::min(count, samples_.size())); }
  /// Motion at any time; before the start and after the end the nearest one.
  [[nodiscard]] Motion at(double time_s) const;
  [[nodiscard]] Eigen::Vector2d velocity(double time_s) const;

 private:
  std::vector<Motion> samples_;
};

/// Lets people cross the picture, stop, turn, come near and go, around the furniture, the camera and each
/// other.
class WalkPlanner {
 public:
  using CameraAt = std::function<geometry::Pose(double time_s)>;
  WalkPlanner(const FloorMap& floor, const geometry::CameraModel& camera, CameraAt world_from_camera,
              double seconds);

  /// From now on people go from room to room, too, and walls hide them from the camera. Without it they stay
  /// where the camera looks.
  void walk_through(const Scene& scene);

  /// Plans one more person, who minds those planned before.
  ///
  /// @param speed  of walking [m/s]
  Walk plan(double speed, Random random);

 private:
  /// One leg: walk to `goal`, then stand for `pause_s` looking towards `look_rad`.
  [[nodiscard]] Walk leg(const Motion& start, const Eigen::Vector2d& goal, double speed, double pause_s,
                         Random& random) const;
  [[nodiscard]] Eigen::Vector2d draw_goal(double time_s, const Eigen::Vector2d& from, Random& random) const;
  [[nodiscard]] Eigen::Vector2d goal_in_view(double time_s, Random& random) const;
  [[nodiscard]] Eigen::Vector2d goal_in_a_room(const Eigen::Vector2d& from, Random& random) const;
  [[nodiscard]] double score(const Walk& walk, double start_s) const;
  [[nodiscard]] double coverage(const Eigen::Vector2d& position,
                                const geometry::Pose& camera_from_world) const;
  [[nodiscard]] Motion enter(double speed, Random& random) const;

  const FloorMap& floor_;
  geometry::CameraModel camera_;
  CameraAt world_from_camera_;
  double seconds_;
  std::vector<geometry::Box3> rooms_;  // empty: people do not leave theirs
  std::optional<FloorMap> sight_;      // free where no wall is
  std::vector<Walk> others_;
};

}  // namespace rds::simulator
