// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/floor_map.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

namespace rds::simulator {
namespace {

constexpr double kCell = 0.05;
constexpr double kPersonHeight = 1.8;

struct Step {
  double cost;
  int cell;
  bool operator>(const Step& other) const {
    return cost != other.cost ? cost > other.cost : cell > other.cell;
  }
};

/// Every point is drawn towards the middle of its neighbours, as long as it stays free.
template <class IsFree>
void smooth(std::vector<Eigen::Vector2d>& line, const IsFree& is_free) {
  for (int round = 0; round < 30; ++round)
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      const Eigen::Vector2d moved = line[i] / 2 + (line[i - 1] + line[i + 1]) / 4;
      if (is_free(moved)) line[i] = moved;
    }
}

}  // namespace

FloorMap::FloorMap(const Scene& scene, double radius) {
  const geometry::Box3 bounds = scene.bounds();
  corner_ = bounds.min.head<2>();
  width_ = static_cast<int>(bounds.size().x() / kCell);
  height_ = static_cast<int>(bounds.size().y() / kCell);
  blocked_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 1);
  for (const Room& room : scene.rooms)
    set(room.box.min.head<2>().array() + radius, room.box.max.head<2>().array() - radius, 0, 0);
  for (const Opening& opening : scene.openings) {
    const Eigen::Vector2d size = opening.box.size().head<2>();
    const Eigen::Vector2d reach =
        size.x() < size.y() ? Eigen::Vector2d(radius, -radius) : Eigen::Vector2d(-radius, radius);
    set(opening.box.min.head<2>() - reach, opening.box.max.head<2>() + reach, 0, 0);
  }
  for (std::size_t i = 1; i < scene.objects.size(); ++i) {
    const geometry::Box3& box = scene.objects[i].box;
    if (box.min.z() > kPersonHeight || box.max.z() < 0.05) continue;
    set(box.min.head<2>(), box.max.head<2>(), radius, 1);
  }
}

/// Sets the cells whose middle is in a rectangle, or less than `margin` away from it.
void FloorMap::set(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double margin,
                   std::uint8_t blocked) {
  const auto range = [&](int axis, int count) {
    const int first = static_cast<int>((low[axis] - margin - corner_[axis]) / kCell) - 1;
    const int last = static_cast<int>((high[axis] + margin - corner_[axis]) / kCell) + 1;
    return std::pair(std::clamp(first, 0, count), std::clamp(last + 1, 0, count));
  };
  const auto [x0, x1] = range(0, width_);
  const auto [y0, y1] = range(1, height_);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const Eigen::Vector2d p = center(y * width_ + x);
      const double distance = (p - p.cwiseMax(low).cwiseMin(high)).norm();
      if (margin > 0 ? distance < margin : distance <= 0)
        blocked_[static_cast<std::size_t>(y * width_ + x)] = blocked;
    }
}

void FloorMap::keep_connected_to(const Eigen::Vector2d& point) {
  std::vector<std::uint8_t> blocked(blocked_.size(), 1);
  std::vector<int> open{cell(nearest_free(point))};
  blocked[static_cast<std::size_t>(open.back())] = 0;
  while (!open.empty()) {
    const int c = open.back();
    open.pop_back();
    for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
      const int x = c % width_ + dx;
      const int y = c / width_ + dy;
      if (x < 0 || y < 0 || x >= width_ || y >= height_) continue;
      const auto next = static_cast<std::size_t>(y * width_ + x);
      if (blocked_[next] != 0 || blocked[next] == 0) continue;
      blocked[next] = 0;
      open.push_back(y * width_ + x);
    }
  }
  blocked_ = std::move(blocked);
}

int FloorMap::cell(const Eigen::Vector2d& point) const {
  const int x = std::clamp(static_cast<int>((point.x() - corner_.x()) / kCell), 0, width_ - 1);
  const int y = std::clamp(static_cast<int>((point.y() - corner_.y()) / kCell), 0, height_ - 1);
  return y * width_ + x;
}

Eigen::Vector2d FloorMap::center(int cell) const {
  const int x = cell % width_;
  const int y = cell / width_;
  return corner_ + kCell * Eigen::Vector2d(x + 0.5, y + 0.5);
}

bool FloorMap::is_free(const Eigen::Vector2d& point) const {
  return blocked_[static_cast<std::size_t>(cell(point))] == 0;
}

Eigen::Vector2d FloorMap::nearest_free(const Eigen::Vector2d& point) const {
  if (is_free(point)) return point;
  Eigen::Vector2d best = Eigen::Vector2d::Zero();
  double nearest = 1e9;
  for (int i = 0; i < static_cast<int>(blocked_.size()); ++i) {
    const double distance = (center(i) - point).squaredNorm();
    if (blocked_[static_cast<std::size_t>(i)] != 0 || distance >= nearest) continue;
    nearest = distance;
    best = center(i);
  }
  return best;
}

std::vector<int> FloorMap::cells_between(int from, int to) const {
  std::vector<double> cost(blocked_.size(), 1e9);
  std::vector<int> parent(blocked_.size(), -1);
  std::priority_queue<Step, std::vector<Step>, std::greater<>> open;
  const auto estimate = [&](int c) { return (center(c) - center(to)).norm() / kCell; };
  cost[static_cast<std::size_t>(from)] = 0;
  open.push({estimate(from), from});
  while (!open.empty() && open.top().cell != to) {
    const int c = open.top().cell;
    open.pop();
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int x = c % width_ + dx;
        const int y = c / width_ + dy;
        if (x < 0 || y < 0 || x >= width_ || y >= height_) continue;
        const int next = y * width_ + x;
        const double total = cost[static_cast<std::size_t>(c)] + std::sqrt(dx * dx + dy * dy);
        if (blocked_[static_cast<std::size_t>(next)] != 0 || total >= cost[static_cast<std::size_t>(next)])
          continue;
        cost[static_cast<std::size_t>(next)] = total;
        parent[static_cast<std::size_t>(next)] = c;
        open.push({total + estimate(next), next});
      }
  }
  if (open.empty()) return {};
  std::vector<int> cells{to};
  while (cells.back() != from) cells.push_back(parent[static_cast<std::size_t>(cells.back())]);
  std::reverse(cells.begin(), cells.end());
  return cells;
}

bool FloorMap::is_clear(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
  const int steps = static_cast<int>((b - a).norm() / (kCell / 2)) + 1;
  for (int i = 0; i <= steps; ++i)
    if (!is_free(a + (b - a) * (static_cast<double>(i) / steps))) return false;
  return true;
}

std::vector<Eigen::Vector2d> FloorMap::path(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
  const auto cells = cells_between(cell(from), cell(to));
  if (cells.empty()) return {};
  // Straight pieces as long as nothing is in the way.
  std::vector<Eigen::Vector2d> corners{from};
  for (std::size_t i = 1; i < cells.size(); ++i)
    if (i + 1 == cells.size() || !is_clear(corners.back(), center(cells[i + 1])))
      corners.push_back(center(cells[i]));
  std::vector<Eigen::Vector2d> line{from};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Eigen::Vector2d edge = corners[i] - corners[i - 1];
    const int steps = std::max(1, static_cast<int>(edge.norm() / kCell));
    for (int k = 1; k <= steps; ++k) line.push_back(corners[i - 1] + edge * (static_cast<double>(k) / steps));
  }
  smooth(line, [this](const Eigen::Vector2d& p) { return is_free(p); });
  return line;
}

}  // namespace rds::simulator
