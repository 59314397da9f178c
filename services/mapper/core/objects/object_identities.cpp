// SPDX-License-Identifier: Apache-2.0
// Which object of a database made again is which of the one before it.
#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "services/mapper/core/objects/object_database.hpp"

namespace rds::mapper {
namespace {

constexpr std::size_t kIdentityBytes = 8 + 8;
constexpr std::size_t kSightingBytes = 8 + 4;

/// An object of the database before and a new one that have sightings in common.
struct Kinship {
  std::size_t sightings = 0;  // in common
  bool is_heir = false;       // at least half of those that the one before had
  std::uint64_t id = 0;       // of the one before
  std::size_t entry = 0;      // of the new one
};

/// Heirs come first, of those who are two things' the one that was known for longer; then who has most in
/// common.
bool comes_before(const Kinship& a, const Kinship& b) {
  if (a.is_heir != b.is_heir) return a.is_heir;
  if (a.is_heir && a.id != b.id) return a.id < b.id;
  return std::tuple(b.sightings, a.id, a.entry) < std::tuple(a.sightings, b.id, b.entry);
}

}  // namespace

void ObjectDatabase::reserve_ids_of(const ObjectDatabase& other) {
  next_id_ = std::max(next_id_, other.next_id_);
}

void ObjectDatabase::take_ids_from(const ObjectDatabase& before) {
  std::map<SightingId, const Entry*> owner;
  for (const Entry& entry : before.entries_)
    for (const SightingId& sighting : entry.sightings) owner.emplace(sighting, &entry);

  std::set<std::uint64_t> taken;
  std::vector<Kinship> kin;
  std::vector<std::size_t> unnamed;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].object.id < before.next_id_) {
      taken.insert(entries_[i].object.id);
      continue;
    }
    unnamed.push_back(i);
    std::map<std::uint64_t, Kinship> of_entry;  // by id
    for (const SightingId& sighting : entries_[i].sightings) {
      const auto found = owner.find(sighting);
      if (found == owner.end()) continue;
      Kinship& k = of_entry[found->second->object.id];
      k = {k.sightings + 1, 2 * (k.sightings + 1) >= found->second->sightings.size(),
           found->second->object.id, i};
    }
    for (const auto& [id, k] : of_entry) kin.push_back(k);
  }
  std::ranges::sort(kin, comes_before);

  std::set<std::size_t> named;
  for (const Kinship& k : kin) {
    if (named.contains(k.entry) || !taken.insert(k.id).second) continue;
    named.insert(k.entry);
    entries_[k.entry].object.id = k.id;
  }
  next_id_ = before.next_id_;
  for (const std::size_t i : unnamed)
    if (!named.contains(i)) entries_[i].object.id = next_id_++;
}

void ObjectDatabase::put_identities(map_file::ByteWriter& writer) const {
  writer.put(next_id_);
  writer.put_count(entries_.size());
  for (const Entry& entry : entries_) {
    writer.put(entry.object.id);
    writer.put_count(entry.sightings.size());
    for (const SightingId& sighting : entry.sightings) {
      writer.put(sighting.keyframe);
      writer.put(sighting.index);
    }
  }
}

void ObjectDatabase::get_identities(map_file::ByteReader& reader) {
  next_id_ = reader.get<std::uint64_t>();
  entries_.assign(reader.get_count(kIdentityBytes), {});
  for (Entry& entry : entries_) {
    entry.object.id = reader.get<std::uint64_t>();
    if (entry.object.id == 0 || entry.object.id >= next_id_) reader.refuse("an object with an impossible id");
    entry.sightings.resize(reader.get_count(kSightingBytes));
    for (SightingId& sighting : entry.sightings)
      sighting = {reader.get<std::uint64_t>(), reader.get<std::uint32_t>()};
    if (!reader.ok()) return entries_.clear();
  }
}

}  // namespace rds::mapper
