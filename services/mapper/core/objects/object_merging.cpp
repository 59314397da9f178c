// SPDX-License-Identifier: Apache-2.0
// The objects of two maps of one place.
#include <algorithm>

#include "services/mapper/core/objects/object_database.hpp"

namespace rds::mapper {
namespace {

/// The box along the map's axes around a box that has moved.
geometry::Box3 moved(const geometry::Box3& box, const geometry::Pose& here_from_there) {
  const Eigen::Vector3d center = here_from_there * box.center();
  const Eigen::Vector3d half = here_from_there.linear().cwiseAbs() * box.size() / 2;
  return {center - half, center + half};
}

}  // namespace

std::size_t ObjectDatabase::let_go_unless(const IsThere& is_there) {
  std::size_t gone = 0;
  for (Entry& entry : entries_) {
    if (entry.object.has_gone || is_there(entry.object)) continue;
    entry.object.has_gone = true;
    ++gone;
  }
  return gone;
}

std::size_t ObjectDatabase::add_later(const ObjectDatabase& later, const HereFromThere& here_from_there) {
  for (Entry& entry : entries_) entry.seen_now = false;
  std::vector<Entry> added = later.entries_;
  std::ranges::sort(added, {}, [](const Entry& entry) { return entry.object.id; });
  std::size_t common = 0;
  for (Entry& entry : added) {
    const geometry::Box3 there{entry.min, entry.max};
    const geometry::Box3 box = moved(there, here_from_there(there.center()));
    entry.min = box.min;
    entry.max = box.max;
    entry.sightings.clear();
    entry.seen_now = true;
    describe(entry);
    Entry* known = object_of(entry.object.label, box);
    if (known == nullptr) {
      entry.object.id = next_id_++;
      entries_.push_back(std::move(entry));
      continue;
    }
    ++common;
    const bool is_back = known->object.has_gone && !entry.object.has_gone;
    if (is_back) known->weight = 0;  // perhaps not just there
    entry.object.id = known->object.id;
    const bool has_gone = entry.object.has_gone;
    merge(*known, entry);
    known->object.has_gone = has_gone;
  }
  return common;
}

}  // namespace rds::mapper
