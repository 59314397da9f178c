// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace rds::map_file {

inline constexpr std::uint64_t kChecksumStart = 0xCBF29CE484222325U;

/// FNV-1a, 64 bit, of what came before (`sum`) and these bytes. One byte that is different always gives
/// another sum.
inline std::uint64_t checksum_of(std::span<const std::uint8_t> bytes, std::uint64_t sum = kChecksumStart) {
  for (const std::uint8_t byte : bytes) sum = (sum ^ byte) * 0x100000001B3U;
  return sum;
}

}  // namespace rds::map_file
