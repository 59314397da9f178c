// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/grid/grid_update.hpp"

#include <algorithm>
#include <cstddef>
#include <map>

namespace rds::mapper {
namespace {

using map_msgs::msg::OccupancyGridUpdate;
using nav_msgs::msg::OccupancyGrid;

bool are_alike(const OccupancyGrid& a, const OccupancyGrid& b) {
  return a.header().frame_id() == b.header().frame_id() && a.info().resolution() == b.info().resolution() &&
         a.info().width() == b.info().width() && a.info().height() == b.info().height() &&
         a.info().origin() == b.info().origin() && a.data().size() == b.data().size();
}

/// First and last, inclusive; none where last < first.
struct Range {
  std::uint32_t first = UINT32_MAX;
  std::uint32_t last = 0;
  void take_in(std::uint32_t at) { first = std::min(first, at), last = std::max(last, at); }
  [[nodiscard]] std::uint32_t count() const { return first > last ? 0 : last - first + 1; }
};

/// The process of a subscription: the first 12 bytes of its GUID, "01.0f.".
std::string process_of(const std::string& guid) {
  return guid.substr(0, 36);
}

}  // namespace

std::optional<OccupancyGridUpdate> grid_update(const OccupancyGrid& before, const OccupancyGrid& now) {
  if (!are_alike(before, now)) return std::nullopt;
  const std::uint32_t width = now.info().width();
  Range columns;
  Range rows;
  for (std::uint32_t y = 0; y < now.info().height(); ++y)
    for (std::uint32_t x = 0; x < width; ++x)
      if (const std::size_t cell = std::size_t{y} * width + x; before.data()[cell] != now.data()[cell])
        columns.take_in(x), rows.take_in(y);
  OccupancyGridUpdate update;
  update.header(now.header());
  if (columns.count() == 0) return update;
  update.x(static_cast<std::int32_t>(columns.first));
  update.y(static_cast<std::int32_t>(rows.first));
  update.width(columns.count());
  update.height(rows.count());
  for (std::uint32_t y = rows.first; y <= rows.last; ++y) {
    const auto row = now.data().begin() + static_cast<std::ptrdiff_t>(std::size_t{y} * width);
    update.data().insert(update.data().end(), row + columns.first, row + columns.last + 1);
  }
  return update;
}

bool GridReaders::all_read_updates() const {
  std::map<std::string, int> lacking;  // of each process, subscriptions to the grid without one to updates
  for (const std::string& guid : grid) ++lacking[process_of(guid)];
  for (const std::string& guid : updates) --lacking[process_of(guid)];
  return std::ranges::none_of(lacking, [](const auto& process) { return process.second > 0; });
}

bool GridReaders::has_new(const GridReaders& before) const {
  return !std::ranges::includes(before.grid, grid) || !std::ranges::includes(before.updates, updates);
}

}  // namespace rds::mapper
