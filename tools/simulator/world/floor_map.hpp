// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulator/world/scene.hpp"

namespace rds::simulator {

/// Where a person can walk: the floor without furniture, widened by half a person.
class FloorMap {
 public:
  explicit FloorMap(const Scene& scene);

  [[nodiscard]] bool is_free(const Eigen::Vector2d& point) const;
  /// The free place nearest to `point`.
  [[nodiscard]] Eigen::Vector2d nearest_free(const Eigen::Vector2d& point) const;
  /// Shortest way between two free places as a smooth line with a point every 5 cm; empty if there is none.
  [[nodiscard]] std::vector<Eigen::Vector2d> path(const Eigen::Vector2d& from,
                                                  const Eigen::Vector2d& to) const;

 private:
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
