// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/bag/mcap_bag_writer.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace rds::recording {

tl::expected<std::unique_ptr<BagWriter>, std::string> McapBagWriter::make(const std::filesystem::path& file,
                                                                          mcap::Compression compression) {
  constexpr mode_t kMode = S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH;
  map_file::Descriptor descriptor(open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kMode));
  if (!descriptor.is_open())
    return tl::unexpected(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
  return std::unique_ptr<BagWriter>(new McapBagWriter(file, std::move(descriptor), compression));
}

McapBagWriter::McapBagWriter(std::filesystem::path file, map_file::Descriptor descriptor,
                             mcap::Compression compression)
    : file_(std::move(file)),
      descriptor_(std::move(descriptor)),
      writer_({.compression = compression, .library = "rds-slam"},
              [this](mcap::View bytes) { return append(bytes); }) {}

tl::expected<std::size_t, std::string> McapBagWriter::add_topic(const BagTopic& topic) {
  mcap::Channel channel{.topic = topic.name,
                        .message_encoding = topic.encoding,
                        .metadata = {{"offered_qos_profiles", topic.qos}}};
  if (!topic.type_hash.empty()) channel.metadata["topic_type_hash"] = topic.type_hash;
  auto id = writer_.add_channel(
      {.name = topic.type, .encoding = topic.definition_encoding, .data = topic.definition},
      std::move(channel));
  if (!id) return tl::unexpected(fmt::format("{}: {}", file_.string(), id.error()));
  return *id;
}

BagWriter::Result McapBagWriter::write(std::size_t topic, const BagMessage& message) {
  return writer_.write({.channel_id = static_cast<std::uint16_t>(topic),
                        .log_time = static_cast<std::uint64_t>(message.log_time_ns),
                        .publish_time = static_cast<std::uint64_t>(message.publish_time_ns),
                        .data = message.data});
}

BagWriter::Result McapBagWriter::flush() {
  return writer_.end_chunk();
}

BagWriter::Result McapBagWriter::finish() {
  return writer_.finish();
}

BagWriter::Result McapBagWriter::append(mcap::View bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_.number(), bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0)
      return tl::unexpected(fmt::format("{}: cannot be written: {}", file_.string(), std::strerror(errno)));
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return {};
}

}  // namespace rds::recording
