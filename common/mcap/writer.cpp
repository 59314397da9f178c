// SPDX-License-Identifier: Apache-2.0
#include "common/mcap/writer.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "common/map_file/byte_writer.hpp"
#include "common/mcap/encoding.hpp"

namespace rds::mcap {

using Result = tl::expected<void, std::string>;

Writer::Writer(WriterOptions options, Sink sink) : options_(std::move(options)), sink_(std::move(sink)) {
  head_.assign(kMagic.begin(), kMagic.end());
  append(head_, Header{options_.profile, options_.library});
}

tl::expected<std::uint16_t, std::string> Writer::add_channel(Schema schema, Channel channel) {
  constexpr std::size_t kMost = std::numeric_limits<std::uint16_t>::max();
  if (channels_.size() >= kMost) return tl::unexpected<std::string>("more than 65535 topics");
  const auto same = std::ranges::find_if(schemas_, [&](const Schema& other) {
    return other.name == schema.name && other.encoding == schema.encoding && other.data == schema.data;
  });
  channel.schema_id = static_cast<std::uint16_t>(1 + (same - schemas_.begin()));
  channel.id = static_cast<std::uint16_t>(channels_.size());
  if (same == schemas_.end()) {
    schema.id = channel.schema_id;
    summary_.add(schema);
    schemas_.push_back(std::move(schema));
  }
  summary_.add(channel);
  const std::uint16_t id = channel.id;
  channels_.push_back({std::move(channel)});
  return id;
}

Result Writer::write(Message message) {
  if (message.channel_id >= channels_.size())
    throw std::invalid_argument("a message of a channel that was not announced");
  KnownChannel& known = channels_[message.channel_id];
  ++known.messages;
  if (message.sequence == 0) message.sequence = known.messages;
  const bool is_first = indexes_.empty();
  MessageIndex& index = indexes_[message.channel_id];
  if (index.empty()) {
    append(records_, schemas_[known.channel.schema_id - 1U]);
    append(records_, known.channel);
  }
  index.emplace_back(message.log_time, records_.size());
  append(records_, message);
  chunk_start_time_ = is_first ? message.log_time : std::min(chunk_start_time_, message.log_time);
  chunk_end_time_ = is_first ? message.log_time : std::max(chunk_end_time_, message.log_time);
  summary_.count_message(message.channel_id, message.log_time);
  if (records_.size() < options_.chunk_bytes) return {};
  return end_chunk();
}

Result Writer::end_chunk() {
  if (indexes_.empty() && head_.empty()) return {};
  if (indexes_.empty()) return give(std::exchange(head_, {}));
  const View compressed = compress(records_, options_.compression, compressed_);
  const Chunk chunk{
      chunk_start_time_, chunk_end_time_, records_.size(), crc32_of(records_), name_of(options_.compression),
      compressed};
  out_.assign(head_.begin(), head_.end());
  head_.clear();
  ChunkIndex index{.start_time = chunk.start_time,
                   .end_time = chunk.end_time,
                   .chunk_offset = given_ + out_.size(),
                   .compression = chunk.compression,
                   .compressed_size = compressed.size(),
                   .uncompressed_size = records_.size()};
  append(out_, chunk);
  const std::uint64_t indexes_start = given_ + out_.size();
  index.chunk_length = indexes_start - index.chunk_offset;
  for (const auto& [channel_id, messages] : indexes_) {
    index.message_index_offsets[channel_id] = given_ + out_.size();
    append(out_, channel_id, messages);
  }
  index.message_index_length = given_ + out_.size() - indexes_start;
  summary_.add(index);
  records_.clear();
  indexes_.clear();
  return give(out_);
}

Result Writer::finish() {
  if (const auto ended = end_chunk(); !ended) return ended;
  Bytes out = std::exchange(head_, {});
  map_file::ByteWriter no_crc;  // of the data as a whole: each chunk has its own
  no_crc.put(std::uint32_t{0});
  append(out, Opcode::kDataEnd, no_crc.bytes());
  const Bytes summary = summary_.encode(given_ + out.size());
  out.insert(out.end(), summary.begin(), summary.end());
  return give(out);
}

Result Writer::give(View bytes) {
  given_ += bytes.size();
  return sink_(bytes);
}

}  // namespace rds::mcap
