// SPDX-License-Identifier: Apache-2.0
#include <set>

#include <fmt/format.h>

#include "common/map_file/geometry_bytes.hpp"
#include "services/mapper/core/objects/object_database.hpp"

namespace rds::mapper {
namespace {

using map_file::ByteReader;
using map_file::ByteWriter;

constexpr std::size_t kObjectBytes = 8 + 8 + 4 + 16 + 1 + 48 + 24;

}  // namespace

void ObjectDatabase::put(ByteWriter& writer) const {
  writer.put(next_id_);
  writer.put_count(entries_.size());
  for (const Entry& entry : entries_) {
    writer.put(entry.object.id);
    entry.labels.put(writer);
    writer.put(entry.object.observations);
    writer.put(entry.object.first_seen_ns);
    writer.put(entry.object.last_seen_ns);
    writer.put(static_cast<std::uint8_t>(entry.object.has_gone));
    map_file::put(writer, entry.min);
    map_file::put(writer, entry.max);
    for (const double sum : {entry.weight, entry.score_sum, entry.existence}) writer.put(sum);
  }
}

void ObjectDatabase::get(ByteReader& reader) {
  next_id_ = reader.get<std::uint64_t>();
  entries_.assign(reader.get_count(kObjectBytes), {});
  std::set<std::uint64_t> ids;
  for (Entry& entry : entries_) {
    entry.object.id = reader.get<std::uint64_t>();
    entry.labels = LabelDistribution::get(reader);
    entry.object.observations = reader.get<std::uint32_t>();
    entry.object.first_seen_ns = reader.get<std::int64_t>();
    entry.object.last_seen_ns = reader.get<std::int64_t>();
    entry.object.has_gone = reader.get<std::uint8_t>() != 0;
    entry.min = map_file::get_vector(reader);
    entry.max = map_file::get_vector(reader);
    for (double* sum : {&entry.weight, &entry.score_sum, &entry.existence}) *sum = reader.get<double>();
    const bool possible = ids.insert(entry.object.id).second && entry.object.id > 0 &&
                          entry.object.id < next_id_ && entry.object.observations > 0 && entry.weight > 0 &&
                          (entry.min.array() <= entry.max.array()).all();
    if (!possible) reader.refuse(fmt::format("object {} with impossible values", entry.object.id));
    if (!reader.ok()) return entries_.clear();
    describe(entry);
  }
}

}  // namespace rds::mapper
