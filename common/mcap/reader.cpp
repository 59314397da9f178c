// SPDX-License-Identifier: Apache-2.0
#include "common/mcap/reader.hpp"

#include <algorithm>

#include "common/mcap/compression.hpp"

namespace rds::mcap {
namespace {

tl::unexpected<std::string> fault(std::string text) {
  return tl::unexpected(std::move(text));
}

/// Calls `visit(opcode, content, offset)` for each record; @return or that one does not fit.
template <class VisitRecord>
Expected<void> for_each_record(View records, VisitRecord visit) {
  std::size_t at = 0;
  while (at < records.size()) {
    const std::size_t left = records.size() - at;
    if (left < kPrefixBytes) return fault("a chunk whose last record is torn");
    const Prefix prefix = decode_prefix(records.subspan(at, kPrefixBytes));
    if (prefix.length > left - kPrefixBytes)
      return fault("a chunk with a record that is longer than the rest");
    visit(prefix.opcode, records.subspan(at + kPrefixBytes, prefix.length), at);
    at += kPrefixBytes + prefix.length;
  }
  return {};
}

}  // namespace

/// A scan on its way.
struct Reader::Sweep {
  const Visit& visit;
  Scan result = {};
  bool data_ended = false;

  void note_damage(const std::string& text) {
    if (result.damaged++ == 0) result.fault = text;
  }
};

Expected<Scan> Reader::scan(const Visit& visit) {
  std::array<std::uint8_t, kMagic.size()> start{};
  if (source_.size() < start.size() || !source_.read(0, start) || start != kMagic)
    return fault("no MCAP file, expected one to begin with 89 4d 43 41 50 30 0d 0a");
  Sweep sweep{visit};
  std::uint64_t at = kMagic.size();
  while (!sweep.data_ended && source_.size() - at >= kPrefixBytes) {
    std::array<std::uint8_t, kPrefixBytes> bytes{};
    if (!source_.read(at, bytes)) return fault("cannot be read");
    const Prefix prefix = decode_prefix(bytes);
    if (static_cast<std::uint8_t>(prefix.opcode) == 0 || prefix.length > source_.size() - at - kPrefixBytes)
      break;
    if (!visit_record(sweep, at, prefix)) return fault("cannot be read");
    at += kPrefixBytes + prefix.length;
  }
  sweep.result.good_bytes = at;
  sweep.result.complete = sweep.data_ended && ends_with_magic();
  return sweep.result;
}

bool Reader::ends_with_magic() const {
  std::array<std::uint8_t, kMagic.size()> end{};
  return source_.read(source_.size() - end.size(), end) && end == kMagic;
}

/// @return false if the source fails.
bool Reader::visit_record(Sweep& sweep, std::uint64_t at, Prefix prefix) {
  switch (prefix.opcode) {
    case Opcode::kDataEnd:
    case Opcode::kFooter:
      sweep.data_ended = true;
      return true;
    case Opcode::kChunk:
      visit_chunk(sweep, at);
      return true;
    case Opcode::kSchema:
    case Opcode::kChannel:
    case Opcode::kMessage: {
      const auto content = record_content(at);
      if (content)
        visit_content(sweep, prefix.opcode, *content, {at, std::nullopt});
      else
        sweep.note_damage(content.error());
      return true;
    }
    default:
      return true;  // of no use to a reader of messages
  }
}

void Reader::visit_chunk(Sweep& sweep, std::uint64_t at) {
  const auto records = chunk_records(at);
  if (!records) return sweep.note_damage(records.error());
  const auto read = for_each_record(*records, [&](Opcode opcode, View content, std::size_t offset) {
    visit_content(sweep, opcode, content, {at, offset});
  });
  if (!read) sweep.note_damage(read.error());
}

void Reader::visit_content(Sweep& sweep, Opcode opcode, View content, const Place& place) {
  if (opcode == Opcode::kMessage) return visit_message(sweep, content, place);
  if (opcode == Opcode::kSchema) {
    auto schema = decode_schema(content);
    if (!schema) return sweep.note_damage(schema.error());
    const std::uint16_t id = schema->id;
    schemas_.try_emplace(id, std::move(*schema));  // a second one has to be the same
  }
  if (opcode == Opcode::kChannel) {
    auto channel = decode_channel(content);
    if (!channel) return sweep.note_damage(channel.error());
    const std::uint16_t id = channel->id;
    channels_.try_emplace(id, std::move(*channel));
  }
}

void Reader::visit_message(Sweep& sweep, View content, const Place& place) {
  const auto message = decode_message(content);
  if (!message) return sweep.note_damage(message.error());
  const auto channel = channels_.find(message->channel_id);
  if (channel == channels_.end())
    return sweep.note_damage("a message of a channel that is nowhere described");
  const auto schema = schemas_.find(channel->second.schema_id);
  ++sweep.result.messages;
  sweep.visit(*message, channel->second, schema == schemas_.end() ? nullptr : &schema->second, place);
}

Expected<Bytes> Reader::record_content(std::uint64_t at) const {
  std::array<std::uint8_t, kPrefixBytes> bytes{};
  if (at > source_.size() || source_.size() - at < kPrefixBytes || !source_.read(at, bytes))
    return fault("a record that is not there");
  const Prefix prefix = decode_prefix(bytes);
  if (prefix.length > std::min(limits_.max_record_bytes, source_.size() - at - kPrefixBytes))
    return fault("a record of " + std::to_string(prefix.length) + " bytes, too long");
  Bytes content(prefix.length);
  if (!source_.read(at + kPrefixBytes, content)) return fault("a record that cannot be read");
  return content;
}

Expected<Bytes> Reader::chunk_records(std::uint64_t at) const {
  const auto content = record_content(at);
  if (!content) return fault(content.error());
  const auto chunk = decode_chunk(*content);
  if (!chunk) return fault(chunk.error());
  const auto compression = compression_from_name(chunk->compression);
  if (!compression) return fault("a chunk with an unknown compression, expected lz4, zstd or none");
  if (chunk->uncompressed_size > limits_.max_record_bytes)
    return fault("a chunk of " + std::to_string(chunk->uncompressed_size) + " bytes, too long");
  auto records = decompress(chunk->records, *compression, chunk->uncompressed_size);
  if (!records) return fault(records.error());
  if (chunk->uncompressed_crc != 0 && chunk->uncompressed_crc != crc32_of(*records))
    return fault("a chunk whose checksum is another one");
  return records;
}

Expected<Bytes> Reader::data_at(const Place& place) const {
  if (!place.in_chunk) {
    const auto content = record_content(place.record);
    if (!content) return fault(content.error());
    const auto message = decode_message(*content);
    if (!message) return fault(message.error());
    return Bytes(message->data.begin(), message->data.end());
  }
  std::shared_ptr<const Bytes> records;
  {
    const std::lock_guard lock(mutex_);
    if (last_chunk_at_ == place.record) records = last_chunk_;
  }
  if (!records) {
    auto read = chunk_records(place.record);
    if (!read) return fault(read.error());
    records = std::make_shared<const Bytes>(std::move(*read));
    const std::lock_guard lock(mutex_);
    last_chunk_at_ = place.record;
    last_chunk_ = records;
  }
  const View all(*records);
  if (*place.in_chunk > all.size() || all.size() - *place.in_chunk < kPrefixBytes)
    return fault("a message that is not in its chunk");
  const View rest = all.subspan(*place.in_chunk);
  const Prefix prefix = decode_prefix(rest);
  if (prefix.opcode != Opcode::kMessage || prefix.length > rest.size() - kPrefixBytes)
    return fault("a message that is not in its chunk");
  const auto message = decode_message(rest.subspan(kPrefixBytes, prefix.length));
  if (!message) return fault(message.error());
  return Bytes(message->data.begin(), message->data.end());
}

}  // namespace rds::mcap
