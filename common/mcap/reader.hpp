// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "common/mcap/decoding.hpp"

namespace rds::mcap {

/// The bytes of a file.
class Source {
 public:
  virtual ~Source() = default;
  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// Fills `into` from that place on; may be called by several threads. @return false if that cannot be.
  [[nodiscard]] virtual bool read(std::uint64_t at, std::span<std::uint8_t> into) const = 0;
};

/// Where a message lies.
struct Place {
  std::uint64_t record = 0;               // of its chunk, or its own
  std::optional<std::uint64_t> in_chunk;  // offset in the chunk's uncompressed records
};

/// What was found when a file was read from its start to its end.
struct Scan {
  bool complete = false;         // it ends as it should; otherwise it was torn after `good_bytes`
  std::uint64_t good_bytes = 0;  // up to the end of the last whole record
  std::uint64_t messages = 0;
  std::uint64_t damaged = 0;  // chunks and records that could not be understood and were left out
  std::string fault = {};     // of the first of these
};

struct ReaderLimits {
  std::uint64_t max_record_bytes = std::uint64_t{1} << 30;  // of a record, and of a chunk's uncompressed ones
};

/// Reads an MCAP file from start to end without relying on its indexes, so that a torn one is read as well.
class Reader {
 public:
  /// @param source  outlives the reader.
  explicit Reader(const Source& source, ReaderLimits limits = {}) : source_(source), limits_(limits) {}

  /// A message, with its channel and schema (nullptr: it has none).
  using Visit = std::function<void(const Message&, const Channel&, const Schema*, const Place&)>;
  /// Visits all messages in the file's order. What is damaged is left out and counted.
  /// @return or that it is no MCAP file.
  Expected<Scan> scan(const Visit& visit);

  /// A message's data again, from the place that scan() told. May be called by several threads.
  [[nodiscard]] Expected<Bytes> data_at(const Place& place) const;

  /// Of those who were seen by scan().
  [[nodiscard]] const std::map<std::uint16_t, Channel>& channels() const { return channels_; }

 private:
  struct Sweep;
  Expected<Bytes> record_content(std::uint64_t at) const;
  Expected<Bytes> chunk_records(std::uint64_t at) const;
  bool visit_record(Sweep& sweep, std::uint64_t at, Prefix prefix);
  void visit_chunk(Sweep& sweep, std::uint64_t at);
  void visit_content(Sweep& sweep, Opcode opcode, View content, const Place& place);
  void visit_message(Sweep& sweep, View content, const Place& place);
  [[nodiscard]] bool ends_with_magic() const;

  const Source& source_;
  ReaderLimits limits_;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  mutable std::mutex mutex_;  // of what follows
  mutable std::uint64_t last_chunk_at_ = 0;
  mutable std::shared_ptr<const Bytes> last_chunk_;  // messages that lie together are read together
};

}  // namespace rds::mcap
