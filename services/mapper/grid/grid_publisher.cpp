// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/grid/grid_publisher.hpp"

#include <utility>

namespace rds::mapper {

GridPublisher::GridPublisher(bus::Participant& bus)
    : bus_(bus),
      grid_(topics::advertise(bus, topics::kMapGrid, topics::kMapper)),
      updates_(topics::advertise(bus, topics::kMapGridUpdates, topics::kMapper)) {}

void GridPublisher::write(nav_msgs::msg::OccupancyGrid grid) {
  GridReaders now = readers();
  const bool is_update_enough = updates_.matched() > 0 && now.all_read_updates() && !now.has_new(served_);
  served_ = std::move(now);
  const auto update = is_update_enough && last_ ? grid_update(*last_, grid) : std::nullopt;
  if (!update)
    grid_.write(grid);
  else if (update->width() > 0)
    updates_.write(*update);
  is_whole_old_ = update && (is_whole_old_ || update->width() > 0);
  last_ = std::move(grid);
}

bool GridPublisher::owes_whole() const {
  return is_whole_old_ && readers().has_new(served_);
}

GridReaders GridPublisher::readers() const {
  const std::string grid = bus_.full_name(topics::kMapGrid.address());
  const std::string updates = bus_.full_name(topics::kMapGridUpdates.address());
  GridReaders readers;
  for (const bus::DiscoveredEndpoint& endpoint : bus_.discovered()) {
    if (endpoint.publisher) continue;
    if (endpoint.topic == grid) readers.grid.insert(endpoint.guid);
    if (endpoint.topic == updates) readers.updates.insert(endpoint.guid);
  }
  return readers;
}

}  // namespace rds::mapper
