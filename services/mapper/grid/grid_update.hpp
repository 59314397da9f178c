// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <string>

#include "map_msgs/msg/OccupancyGridUpdate.h"
#include "nav_msgs/msg/OccupancyGrid.h"

namespace rds::mapper {

/// What has changed from one grid to the next: the smallest rectangle that holds all cells that differ, with
/// the header of `now`; width and height are 0 where none does.
/// @return nullopt where size, origin, resolution or frame is another, so that a reader needs the whole grid.
std::optional<map_msgs::msg::OccupancyGridUpdate> grid_update(const nav_msgs::msg::OccupancyGrid& before,
                                                              const nav_msgs::msg::OccupancyGrid& now);

/// Who reads the grid, by the GUIDs of the subscriptions.
struct GridReaders {
  std::set<std::string> grid;     // the whole one
  std::set<std::string> updates;  // what changes of it

  /// Whether whoever reads the grid reads its updates, too: in each process there are as many subscriptions
  /// to these as to that.
  [[nodiscard]] bool all_read_updates() const;
  /// Whether one of them was not there before.
  [[nodiscard]] bool has_new(const GridReaders& before) const;
};

}  // namespace rds::mapper
