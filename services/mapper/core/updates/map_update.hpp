// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/mapper/core/octree/map_delta.hpp"

namespace rds::mapper {

/// What brings a reader of the map to a newer revision: of revision 0, the whole map.
struct MapUpdate {
  MapDelta delta;
  std::vector<std::string> labels;  // label table; index 0 is ""
};

/// An update for a slow link: one zstd frame that says its size and has a checksum. It holds the voxels in
/// the order of their Morton codes, as distances from one to the next, and their values byte by byte (all
/// lowest bytes, the next ones, and so on).
/// @throws std::invalid_argument for voxels in another order, or arrays that do not fit each other.
std::vector<std::uint8_t> pack(const MapUpdate& update);

/// The reverse, for bytes of anyone.
/// @return or one sentence. Nothing is decoded beyond the size that the frame says, which may be kFreeBytes +
/// kBytesPerByte times that of the frame; the arrays fit each other, and no voxel comes twice.
tl::expected<MapUpdate, std::string> unpack_update(std::span<const std::uint8_t> bytes);

/// What an update is to bring a reader from one revision to another, or further.
struct UpdateSpan {
  std::uint64_t since = 0;  // 0: the reader has nothing
  std::uint64_t until = 0;
};
/// The revisions in one number: the first one in its upper half. Revisions below 2^32.
constexpr std::uint64_t update_number(const UpdateSpan& span) { return span.since << 32U | span.until; }
constexpr UpdateSpan span_of(std::uint64_t number) { return {number >> 32U, number & 0xFFFFFFFFU}; }

inline constexpr std::size_t kFreeBytes = std::size_t{16} << 20U;
inline constexpr std::size_t kBytesPerByte = 64;

}  // namespace rds::mapper
