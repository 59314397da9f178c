// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/final_map.hpp"

#include <cstdlib>
#include <utility>

namespace rds::mapper {
namespace {

using map_file::ByteReader;
using map_file::ByteWriter;

constexpr std::uint32_t kOften = 1000;  // more keyframes than any that speak against a saved voxel
constexpr std::size_t kVoxelBytes = 2 + 1 + 2 * 2 + 2 * 1 + 2 * (4 + 2 * 4);
constexpr std::uint64_t kLastKey = 0xFFFF'FFFF'FFFF;
// What a voxel is, in the bits of a byte.
constexpr unsigned kKnown = 1;
constexpr unsigned kRemembered = 2;

bool says_something(const FinalBlock& block, std::size_t cell) {
  return block.occupancy.known.has(cell) || block.counts.statics.count[cell] > 0 ||
         block.counts.dynamics.count[cell] > 0;
}

/// Calls go(value) for each value of a cell but its look and whether it is known.
template <class Block, class Go>
void each_value(Block& block, std::size_t cell, Go go) {
  go(block.occupancy.values[cell]);
  go(block.occupancy.lasting[cell]);
  go(block.occupancy.row[cell]);
  go(block.occupancy.balance[cell]);
  for (auto* sightings : {&block.counts.statics, &block.counts.dynamics}) {
    go(sightings->count[cell]);
    go(sightings->first[cell]);
    go(sightings->last[cell]);
  }
}

void put(ByteWriter& writer, const FinalBlock& block) {
  std::size_t cells = 0;
  for (std::size_t cell = 0; cell < kBlockCells; ++cell) cells += says_something(block, cell) ? 1 : 0;
  writer.put_count(cells);
  for (std::size_t cell = 0; cell < kBlockCells; ++cell) {
    if (!says_something(block, cell)) continue;
    writer.put(static_cast<std::uint16_t>(cell));
    const BlockOccupancy& voxels = block.occupancy;
    writer.put(static_cast<std::uint8_t>((voxels.known.has(cell) ? kKnown : 0) |
                                         (voxels.remembered.has(cell) ? kRemembered : 0)));
    each_value(block, cell, [&](const auto& value) { writer.put(value); });
  }
  writer.put_count(block.looks.size());
  for (const auto& [cell, look] : block.looks) {
    writer.put(cell);
    look.put(writer);
  }
}

std::uint16_t get_cell(ByteReader& reader) {
  const auto cell = reader.get<std::uint16_t>();
  if (cell >= kBlockCells) reader.refuse("a voxel outside of its block");
  return reader.ok() ? cell : std::uint16_t{0};
}

/// What put() cannot have written of a cell; nullptr if it can.
const char* fault_of(const FinalBlock& block, std::size_t cell) {
  const BlockOccupancy& voxels = block.occupancy;
  for (const LogOdds log_odds : {voxels.values[cell], voxels.lasting[cell]})
    if (log_odds < kLowest || log_odds > kHighest) return "log-odds beyond their limits";
  if (std::abs(voxels.row[cell]) > kSolidRow) return "a row of hits that is too long";
  if (std::abs(voxels.balance[cell]) > kMostBalance) return "a balance beyond its limits";
  for (const Sightings* sightings : {&block.counts.statics, &block.counts.dynamics})
    for (const EvidenceTime time : {sightings->first[cell], sightings->last[cell]})
      if (time < kBeforeAll || time > kAfterAll) return "a time outside of all times";
  return nullptr;
}

FinalBlock get_block(ByteReader& reader, std::size_t labels) {
  FinalBlock block;
  const std::size_t cells = reader.get_count(kVoxelBytes);
  for (std::size_t i = 0; i < cells && reader.ok(); ++i) {
    const auto cell = get_cell(reader);
    const unsigned what = reader.get<std::uint8_t>();
    if (what > (kKnown | kRemembered)) reader.refuse("a voxel of no kind");
    if ((what & kKnown) != 0) block.occupancy.known.insert(cell);
    if ((what & kRemembered) != 0) block.occupancy.remembered.insert(cell);
    each_value(block, cell, [&](auto& value) { value = reader.get<std::decay_t<decltype(value)>>(); });
    if (const auto fault = fault_of(block, cell); fault != nullptr) reader.refuse(fault);
  }
  const std::size_t looks = reader.get_count(sizeof(std::uint16_t));
  for (std::size_t i = 0; i < looks && reader.ok(); ++i) {
    const auto cell = get_cell(reader);
    block.looks[cell] = VoxelLook::get(reader, labels);
  }
  return block;
}

}  // namespace

void FinalBlock::add(std::uint16_t cell, LogOdds log_odds, const VoxelLook& look) {
  occupancy.values[cell] = occupancy.lasting[cell] = log_odds;
  occupancy.known.insert(cell);
  if (log_odds <= 0) return;
  occupancy.remembered.insert(cell);
  if (log_odds == kHighest) occupancy.row[cell] = kSolidRow;  // it has stood for long
  occupancy.balance[cell] = kMostBalance;
  counts.statics.count[cell] = kOften;
  counts.statics.first[cell] = kBeforeAll;
  counts.statics.last[cell] = kAfterAll;
  looks[cell] = look;
}

const LogOdds* FinalMap::value(const octomap::OcTreeKey& voxel) const {
  const auto block = blocks.find(packed(block_key(voxel)));
  const std::uint16_t cell = cell_of(voxel);
  const bool is_known = block != blocks.end() && block->second->occupancy.known.has(cell);
  return is_known ? &block->second->occupancy.values[cell] : nullptr;
}

const VoxelLook* FinalMap::look(const octomap::OcTreeKey& voxel) const {
  const LogOdds* log_odds = value(voxel);
  if (log_odds == nullptr || *log_odds <= 0) return nullptr;
  const auto& looks = blocks.at(packed(block_key(voxel)))->looks;
  const auto look = looks.find(cell_of(voxel));
  return look == looks.end() ? nullptr : &look->second;
}

void FinalMap::put(ByteWriter& writer) const {
  writer.put(static_cast<std::uint8_t>(origin_ms.has_value()));
  writer.put(origin_ms.value_or(0));
  writer.put_count(blocks.size());
  for (const auto& [key, block] : blocks) {
    writer.put(key);
    mapper::put(writer, *block);
  }
}

FinalMap FinalMap::get(ByteReader& reader, std::size_t labels) {
  FinalMap map;
  const bool has_origin = reader.get<std::uint8_t>() != 0;
  const auto origin_ms = reader.get<std::int64_t>();
  if (has_origin) map.origin_ms = origin_ms;
  const std::size_t blocks = reader.get_count(sizeof(std::uint64_t));
  for (std::size_t i = 0; i < blocks && reader.ok(); ++i) {
    const auto key = reader.get<std::uint64_t>();
    if (key > kLastKey || packed(block_key(unpacked(key))) != key)
      reader.refuse("a block outside of any map");
    auto block = std::make_shared<const FinalBlock>(get_block(reader, labels));
    if (!map.blocks.emplace(key, std::move(block)).second) reader.refuse("a block twice");
  }
  return map;
}

}  // namespace rds::mapper
