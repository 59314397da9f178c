// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/submaps.hpp"

#include <algorithm>
#include <iterator>

namespace rds::tracker {

SubmapId Submaps::of(KeyframeId keyframe) const {
  const auto next = rows_.upper_bound(keyframe);
  return next == rows_.begin() ? kMap : std::prev(next)->second;
}

void Submaps::go_on(SubmapId submap, KeyframeId from) {
  next_ = std::max(next_, submap + 1);
  if (of(from) != submap) rows_.insert_or_assign(from, submap);
}

void Submaps::join(SubmapId joined, SubmapId into) {
  SubmapId before = kMap;
  for (auto row = rows_.begin(); row != rows_.end();) {
    if (row->second == joined) row->second = into;
    const bool goes_on = row->second == before;
    before = row->second;
    row = goes_on ? rows_.erase(row) : std::next(row);
  }
}

bool Submaps::is_whole() const {
  return std::ranges::all_of(rows_, [](const auto& row) { return row.second == kMap; });
}

}  // namespace rds::tracker
