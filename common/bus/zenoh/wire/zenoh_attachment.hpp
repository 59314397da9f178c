// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "common/bus/guid.hpp"

namespace rds::bus::detail {

/// What rmw_zenoh sends beside each message, and without which it drops it.
struct ZenohAttachment {
  std::int64_t sequence = 0;  // the writer's first message is 1
  std::int64_t stamp_ns = 0;  // since the epoch
  Guid gid{};                 // of the writer
};

/// Sequence and stamp, little-endian; the gid's length; the gid.
inline constexpr std::size_t kAttachmentSize = 33;

std::array<std::uint8_t, kAttachmentSize> to_bytes(const ZenohAttachment& attachment);
/// @return nullopt for what is none.
std::optional<ZenohAttachment> parse_attachment(std::span<const std::uint8_t> bytes);

/// Counts what has not come, by the numbers in the attachments. For one thread.
class SequenceGaps {
 public:
  /// @return how many messages of this writer are missing before this one.
  std::uint64_t count(const ZenohAttachment& attachment);

 private:
  static constexpr std::size_t kMostWriters = 1024;  // a stranger may make up any number of them
  std::map<Guid, std::int64_t> last_;
};

}  // namespace rds::bus::detail
