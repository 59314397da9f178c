// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include <tl/expected.hpp>

#include "common/mcap/compression.hpp"
#include "common/mcap/summary.hpp"

namespace rds::mcap {

struct WriterOptions {
  Compression compression = Compression::kLz4;
  std::size_t chunk_bytes = std::size_t{1} << 20;  // a chunk ends with the message that reaches this
  std::string profile = "ros2";
  std::string library = {};  // who writes
};

/// Takes the bytes of a file in order. @return or what is wrong.
using Sink = std::function<tl::expected<void, std::string>(View bytes)>;

/// Makes an MCAP file of messages.
///
/// Bytes leave it chunk by chunk, each with its message indexes and the description of its channels, so what
/// was given to the sink is readable whatever happens to the rest. After a fault of the sink nothing more may
/// be written. Not thread-safe.
class Writer {
 public:
  Writer(WriterOptions options, Sink sink);

  /// Announces a topic; the ids of schema and channel are set here.
  /// @return the channel's id, or that there are too many.
  tl::expected<std::uint16_t, std::string> add_channel(Schema schema, Channel channel);

  /// @param message  of a channel that was announced; its sequence counts within the channel if it is 0.
  tl::expected<void, std::string> write(Message message);
  /// Gives what waits to the sink; the first time at least the beginning of the file.
  tl::expected<void, std::string> end_chunk();
  /// Gives the rest of the file to the sink.
  tl::expected<void, std::string> finish();

  [[nodiscard]] std::uint64_t messages() const { return summary_.messages(); }
  /// Bytes that wait for the end of the chunk.
  [[nodiscard]] std::size_t waiting_bytes() const { return records_.size(); }

 private:
  struct KnownChannel {
    Channel channel;
    std::uint32_t messages = 0;
  };
  tl::expected<void, std::string> give(View bytes);

  WriterOptions options_;
  Sink sink_;
  Bytes head_;               // magic and header, until the first chunk
  std::uint64_t given_ = 0;  // bytes
  Summary summary_;
  std::vector<Schema> schemas_;         // schema i + 1
  std::vector<KnownChannel> channels_;  // channel i
  Bytes records_;                       // of the present chunk
  Bytes compressed_;                    // room for it, compressed
  Bytes out_;                           // room for what is given
  std::map<std::uint16_t, MessageIndex> indexes_;
  std::uint64_t chunk_start_time_ = 0;
  std::uint64_t chunk_end_time_ = 0;
};

}  // namespace rds::mcap
