// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/topics/endpoints.hpp"
#include "services/mapper/grid/grid_update.hpp"

namespace rds::mapper {

/// Writes the 2-D grid: whole, or what has changed of it where that is enough for all who read it.
///
/// Enough it is where whoever reads the grid reads its updates, too, nobody of them is new, and size, origin
/// and resolution are as before. For one thread at a time.
class GridPublisher {
 public:
  explicit GridPublisher(bus::Participant& bus);

  void write(nav_msgs::msg::OccupancyGrid grid);
  /// Subscriptions to the grid or its updates.
  [[nodiscard]] int matched() const { return grid_.matched() + updates_.matched(); }
  /// Whether somebody has come since the last write, when the last whole grid was no longer the newest one.
  [[nodiscard]] bool owes_whole() const;

 private:
  [[nodiscard]] GridReaders readers() const;

  bus::Participant& bus_;
  bus::Publisher<nav_msgs::msg::OccupancyGrid> grid_;
  bus::Publisher<map_msgs::msg::OccupancyGridUpdate> updates_;
  std::optional<nav_msgs::msg::OccupancyGrid> last_;
  GridReaders served_;         // by the last write
  bool is_whole_old_ = false;  // updates came after the last whole grid
};

}  // namespace rds::mapper
