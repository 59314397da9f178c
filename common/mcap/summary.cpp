// SPDX-License-Identifier: Apache-2.0
#include "common/mcap/summary.hpp"

#include <algorithm>

#include "common/map_file/byte_writer.hpp"
#include "common/mcap/compression.hpp"
#include "common/mcap/encoding.hpp"

namespace rds::mcap {
namespace {

using map_file::ByteWriter;

/// Appends the records of one group, and to `offsets` where they lie.
template <class Records>
void append_group(Bytes& out, Bytes& offsets, Opcode opcode, std::uint64_t start, const Records& records) {
  const std::uint64_t begin = start + out.size();
  for (const auto& record : records) append(out, record);
  const std::uint64_t length = start + out.size() - begin;
  if (length == 0) return;
  ByteWriter content;
  content.put(static_cast<std::uint8_t>(opcode));
  content.put(begin);
  content.put(length);
  append(offsets, Opcode::kSummaryOffset, content.bytes());
}

struct Statistics {
  Bytes content;
};
void append(Bytes& out, const Statistics& statistics) {
  append(out, Opcode::kStatistics, statistics.content);
}

}  // namespace

void Summary::count_message(std::uint16_t channel_id, std::uint64_t log_time) {
  ++channel_messages_[channel_id];
  start_time_ = messages_ == 0 ? log_time : std::min(start_time_, log_time);
  end_time_ = std::max(end_time_, log_time);
  ++messages_;
}

Bytes Summary::statistics() const {
  ByteWriter content;
  content.put(messages_);
  content.put(static_cast<std::uint16_t>(schemas_.size()));
  content.put(static_cast<std::uint32_t>(channels_.size()));
  content.put(std::uint32_t{0});  // attachments
  content.put(std::uint32_t{0});  // metadata records
  content.put(static_cast<std::uint32_t>(chunks_.size()));
  content.put(start_time_);
  content.put(end_time_);
  constexpr std::size_t kEntryBytes = 10;
  content.put(static_cast<std::uint32_t>(kEntryBytes * channel_messages_.size()));
  for (const auto& [channel_id, count] : channel_messages_) {
    content.put(channel_id);
    content.put(count);
  }
  return content.take();
}

Bytes Summary::encode(std::uint64_t start) const {
  Bytes out;
  Bytes offsets;
  append_group(out, offsets, Opcode::kSchema, start, schemas_);
  append_group(out, offsets, Opcode::kChannel, start, channels_);
  append_group(out, offsets, Opcode::kStatistics, start, std::vector<Statistics>{{statistics()}});
  append_group(out, offsets, Opcode::kChunkIndex, start, chunks_);
  const std::uint64_t offsets_start = start + out.size();
  out.insert(out.end(), offsets.begin(), offsets.end());
  constexpr std::uint64_t kFooterBytes = 20;
  ByteWriter footer;
  footer.put(static_cast<std::uint8_t>(Opcode::kFooter));
  footer.put(kFooterBytes);
  footer.put(start);
  footer.put(offsets_start);
  out.insert(out.end(), footer.bytes().begin(), footer.bytes().end());
  ByteWriter crc;
  crc.put(crc32_of(out));  // of all from the summary's start to here
  out.insert(out.end(), crc.bytes().begin(), crc.bytes().end());
  out.insert(out.end(), kMagic.begin(), kMagic.end());
  return out;
}

}  // namespace rds::mcap
