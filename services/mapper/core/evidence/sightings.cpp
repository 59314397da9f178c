// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/sightings.hpp"

namespace rds::mapper {

void Sightings::add(const BlockMask& cells, EvidenceTime time) {
  cells.for_each([&](std::size_t cell) {
    ++count[cell];
    if (time <= first[cell]) {
      first[cell] = time;
      first_is_open.erase(cell);
    }
    if (time >= last[cell]) {
      last[cell] = time;
      last_is_open.erase(cell);
    }
  });
}

void Sightings::remove(const BlockMask& cells, EvidenceTime time) {
  cells.for_each([&](std::size_t cell) {
    if (--count[cell] == 0) {
      first[cell] = kAfterAll;
      last[cell] = kBeforeAll;
      first_is_open.erase(cell);
      last_is_open.erase(cell);
      return;
    }
    if (time == first[cell]) first_is_open.insert(cell);
    if (time == last[cell]) last_is_open.insert(cell);
  });
}

bool is_transient(const BlockCounts& counts, std::size_t cell, EvidenceTime apart) {
  const auto& [statics, dynamics] = counts;
  return statics.count[cell] < dynamics.count[cell] && statics.first[cell] > dynamics.first[cell] - apart &&
         statics.last[cell] < dynamics.last[cell] + apart;
}

}  // namespace rds::mapper
