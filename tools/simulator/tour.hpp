// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulator/rendering/random.hpp"
#include "tools/simulator/world/floor_map.hpp"

namespace rds::simulator {

/// In which order a robot visits the rooms: mostly one of the nearest that it has not seen yet, and every
/// third time one where it has been before.
class Tour {
 public:
  /// @param floor  where the robot can go; outlives the tour.
  Tour(const Scene& scene, const FloorMap& floor, std::uint64_t seed);

  /// A free place in the next room.
  Eigen::Vector2d next(const Eigen::Vector2d& position);

 private:
  [[nodiscard]] std::size_t draw_room(const Eigen::Vector2d& position);

  const FloorMap& floor_;
  Random random_;
  std::vector<geometry::Box3> rooms_;
  std::vector<int> last_visit_;  // 0: never
  int visits_ = 0;
};

}  // namespace rds::simulator
