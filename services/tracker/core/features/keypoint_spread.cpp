// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/features/keypoint_spread.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <tuple>

namespace rds::tracker {
namespace {

using Iterator = std::vector<Corner>::iterator;

/// A cell of the quadtree and the range of corners in it.
struct Cell {
  Iterator begin;
  Iterator end;
  float x0, y0, x1, y1;
  int depth;          // in the tree
  std::size_t order;  // of making, so that equally full cells have a fixed sequence

  [[nodiscard]] auto count() const { return end - begin; }
};

/// The cell with the largest product of corners and area is split next. By corners alone a crowd would be
/// split until it has all cells there are; by area alone, the strong corners of rich texture would give way
/// to any weak one.
struct SplitLater {
  static double urgency(const Cell& c) { return std::ldexp(static_cast<double>(c.count()), -2 * c.depth); }
  bool operator()(const Cell& a, const Cell& b) const {
    return std::tuple(urgency(a), b.order) < std::tuple(urgency(b), a.order);
  }
};

using CellQueue = std::priority_queue<Cell, std::vector<Cell>, SplitLater>;

constexpr float kSmallestCell = 2;  // px; corners nearer than this are one

void split(const Cell& cell, CellQueue& queue, std::size_t& made) {
  const float x = (cell.x0 + cell.x1) / 2;
  const float y = (cell.y0 + cell.y1) / 2;
  const auto middle = std::partition(cell.begin, cell.end, [y](const Corner& c) { return c.y < y; });
  const auto is_left = [x](const Corner& c) { return c.x < x; };
  const auto top = std::partition(cell.begin, middle, is_left);
  const auto bottom = std::partition(middle, cell.end, is_left);
  const int depth = cell.depth + 1;
  const std::array quarters{Cell{cell.begin, top, cell.x0, cell.y0, x, y, depth, 0},
                            Cell{top, middle, x, cell.y0, cell.x1, y, depth, 0},
                            Cell{middle, bottom, cell.x0, y, x, cell.y1, depth, 0},
                            Cell{bottom, cell.end, x, y, cell.x1, cell.y1, depth, 0}};
  for (Cell quarter : quarters) {
    if (quarter.count() == 0) continue;
    quarter.order = made++;
    queue.push(quarter);
  }
}

/// The first cells: columns about as wide as the picture is high.
CellQueue first_cells(std::vector<Corner>& corners, float width, float height, std::size_t& made) {
  const int columns = std::max(1, static_cast<int>(std::lround(width / std::max(height, 1.0F))));
  CellQueue queue;
  auto begin = corners.begin();
  for (int c = 0; c < columns; ++c) {
    const float x0 = width * static_cast<float>(c) / static_cast<float>(columns);
    const float x1 = width * static_cast<float>(c + 1) / static_cast<float>(columns);
    const auto end = c + 1 == columns ? corners.end()
                                      : std::partition(begin, corners.end(),
                                                       [x1](const Corner& corner) { return corner.x < x1; });
    if (end != begin) queue.push({begin, end, x0, 0, x1, height, 0, made++});
    begin = end;
  }
  return queue;
}

const Corner& strongest(const Cell& cell) {
  return *std::max_element(cell.begin, cell.end, [](const Corner& a, const Corner& b) {
    return std::tie(a.score, b.y, b.x) < std::tie(b.score, a.y, a.x);
  });
}

}  // namespace

std::vector<Corner> spread_evenly(std::vector<Corner>& corners, float width, float height,
                                  std::size_t wanted) {
  if (corners.size() <= wanted) return corners;
  std::size_t made = 0;
  CellQueue queue = first_cells(corners, width, height, made);
  std::vector<Cell> leaves;
  while (!queue.empty() && queue.size() + leaves.size() < wanted) {
    const Cell cell = queue.top();
    queue.pop();
    if (cell.count() == 1 || cell.x1 - cell.x0 < kSmallestCell)
      leaves.push_back(cell);
    else
      split(cell, queue, made);
  }
  for (; !queue.empty(); queue.pop()) leaves.push_back(queue.top());
  std::vector<Corner> chosen;
  chosen.reserve(leaves.size());
  for (const Cell& cell : leaves) chosen.push_back(strongest(cell));
  // The last split may have made up to three cells too many: the weakest corners go.
  if (chosen.size() > wanted) {
    std::ranges::stable_sort(chosen, std::ranges::greater{}, &Corner::score);
    chosen.resize(wanted);
  }
  std::ranges::sort(chosen,
                    [](const Corner& a, const Corner& b) { return std::tie(a.y, a.x) < std::tie(b.y, b.x); });
  return chosen;
}

}  // namespace rds::tracker
