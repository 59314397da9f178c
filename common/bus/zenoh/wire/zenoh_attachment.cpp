// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/wire/zenoh_attachment.hpp"

namespace rds::bus::detail {
namespace {

constexpr std::size_t kGidLengthAt = 16;
constexpr std::size_t kGidAt = 17;

void put(std::int64_t value, std::uint8_t* bytes) {
  for (std::size_t i = 0; i < 8; ++i)
    bytes[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
}

std::int64_t get(const std::uint8_t* bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 8; ++i) value |= std::uint64_t{bytes[i]} << (8 * i);
  return static_cast<std::int64_t>(value);
}

}  // namespace

std::array<std::uint8_t, kAttachmentSize> to_bytes(const ZenohAttachment& attachment) {
  std::array<std::uint8_t, kAttachmentSize> bytes{};
  put(attachment.sequence, bytes.data());
  put(attachment.stamp_ns, bytes.data() + 8);
  bytes[kGidLengthAt] = static_cast<std::uint8_t>(attachment.gid.size());
  std::ranges::copy(attachment.gid, bytes.begin() + kGidAt);
  return bytes;
}

std::optional<ZenohAttachment> parse_attachment(std::span<const std::uint8_t> bytes) {
  ZenohAttachment attachment;
  if (bytes.size() != kAttachmentSize || bytes[kGidLengthAt] != attachment.gid.size()) return std::nullopt;
  attachment.sequence = get(bytes.data());
  attachment.stamp_ns = get(bytes.data() + 8);
  if (attachment.sequence < 0) return std::nullopt;
  std::ranges::copy(bytes.subspan(kGidAt), attachment.gid.begin());
  return attachment;
}

std::uint64_t SequenceGaps::count(const ZenohAttachment& attachment) {
  if (last_.size() >= kMostWriters && !last_.contains(attachment.gid)) last_.clear();
  const auto [last, first] = last_.try_emplace(attachment.gid, attachment.sequence);
  if (first || attachment.sequence <= last->second) return 0;
  const auto missing = static_cast<std::uint64_t>(attachment.sequence - last->second - 1);
  last->second = attachment.sequence;
  return missing;
}

}  // namespace rds::bus::detail
