// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulator/world/scene.hpp"

namespace rds::simulator {

/// Where a person or a robot can go: the floor of all rooms and doorways without furniture, all obstacles
/// widened by half of the one who goes there.
class FloorMap {
 public:
  static constexpr double kHalfPerson = 0.27;

  /// @param radius  of who goes there [m]
  explicit FloorMap(const Scene& scene, double radius = kHalfPerson);

  [[nodiscard]] bool is_free(const Eigen::Vector2d& point) const;
  /// Takes away what cannot be reached from the free place nearest to `point`.
  void keep_connected_to(const Eigen::Vector2d& point);
  /// The free place nearest to `point`.
  [[nodiscard]] Eigen::Vector2d nearest_free(const Eigen::Vector2d& point) const;
  /// Shortest way between two free places as a smooth line with a point every 5 cm; empty if there is none.
  [[nodiscard]] std::vector<Eigen::Vector2d> path(const Eigen::Vector2d& from,
                                                  const Eigen::Vector2d& to) const;

 private:
  void set(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double margin, std::uint8_t blocked);
  [[nodiscard]] int cell(const Eigen::Vector2d& point) const;
  [[nodiscard]] Eigen::Vector2d center(int cell) const;
  [[nodiscard]] std::vector<int> cells_between(int from, int to) const;
  [[nodiscard]] bool is_clear(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;

  Eigen::Vector2d corner_;
  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint8_t> blocked_;
};

}  // namespace rds::simulator
