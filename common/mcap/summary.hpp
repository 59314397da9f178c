// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "common/mcap/records.hpp"

namespace rds::mcap {

/// What an MCAP file says at its end of all that is in it: schemas and channels, statistics, where the chunks
/// are.
class Summary {
 public:
  void add(const Schema& schema) { schemas_.push_back(schema); }
  void add(const Channel& channel) { channels_.push_back(channel); }
  void add(const ChunkIndex& chunk) { chunks_.push_back(chunk); }
  void count_message(std::uint16_t channel_id, std::uint64_t log_time);

  [[nodiscard]] std::uint64_t messages() const { return messages_; }

  /// From the end of the data to the end of the file: summary, offsets of its groups, footer, magic.
  /// @param start  place of the first byte in the file.
  [[nodiscard]] Bytes encode(std::uint64_t start) const;

 private:
  [[nodiscard]] Bytes statistics() const;

  std::vector<Schema> schemas_;
  std::vector<Channel> channels_;
  std::vector<ChunkIndex> chunks_;
  std::map<std::uint16_t, std::uint64_t> channel_messages_;
  std::uint64_t messages_ = 0;
  std::uint64_t start_time_ = 0;
  std::uint64_t end_time_ = 0;
};

}  // namespace rds::mcap
