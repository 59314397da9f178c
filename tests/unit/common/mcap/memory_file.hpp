// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "common/mcap/reader.hpp"
#include "common/mcap/writer.hpp"

namespace rds::mcap::test {

/// A file in memory.
class MemoryFile final : public Source {
 public:
  MemoryFile() = default;
  explicit MemoryFile(View bytes) : bytes_(bytes.begin(), bytes.end()) {}

  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
  [[nodiscard]] bool read(std::uint64_t at, std::span<std::uint8_t> into) const override {
    if (at > bytes_.size() || into.size() > bytes_.size() - at) return false;
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at), into.size(), into.begin());
    return true;
  }
  [[nodiscard]] Sink sink() {
    return [this](View bytes) {
      bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
      return tl::expected<void, std::string>();
    };
  }
  Bytes& bytes() { return bytes_; }

 private:
  Bytes bytes_;
};

inline std::uint16_t add_topic(Writer& writer, const std::string& topic, const std::string& type) {
  return writer
      .add_channel({.name = type, .encoding = "ros2msg", .data = "string text\n"},
                   {.topic = topic, .message_encoding = "cdr", .metadata = {{"offered_qos_profiles", ""}}})
      .value();
}

/// Topic, log time and data of each message.
using Seen = std::vector<std::tuple<std::string, std::uint64_t, Bytes>>;

inline Scan read_all(const Source& file, Seen& seen, ReaderLimits limits = {}) {
  return Reader(file, limits)
      .scan([&](const Message& m, const Channel& channel, const Schema*, const Place&) {
        seen.emplace_back(channel.topic, m.log_time, Bytes(m.data.begin(), m.data.end()));
      })
      .value();
}

}  // namespace rds::mcap::test
