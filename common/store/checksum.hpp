// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string_view>

namespace rds::store {

inline constexpr std::uint64_t kChecksumStart = 0xCBF29CE484222325U;

/// FNV-1a, 64 bit, of what came before (`sum`) and these bytes. One byte that is different always gives
/// another sum.
inline std::uint64_t checksum_of(std::span<const std::uint8_t> bytes, std::uint64_t sum = kChecksumStart) {
  for (const std::uint8_t byte : bytes) sum = (sum ^ byte) * 0x100000001B3U;
  return sum;
}

/// Of a row of a store: kind, id and bytes.
inline std::uint64_t checksum_of(std::string_view kind, std::uint64_t id,
                                 std::span<const std::uint8_t> bytes) {
  std::uint64_t sum = kChecksumStart;
  for (const char character : kind) sum = (sum ^ static_cast<std::uint8_t>(character)) * 0x100000001B3U;
  const auto raw = std::bit_cast<std::array<std::uint8_t, sizeof(id)>>(id);
  return checksum_of(bytes, checksum_of(raw, sum));
}

}  // namespace rds::store
