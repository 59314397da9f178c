// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/bag/mcap_bag.hpp"

#include <map>

#include <fmt/format.h>

namespace rds::recording {
namespace {

std::string metadata_of(const mcap::Channel& channel, const char* key) {
  const auto found = channel.metadata.find(key);
  return found == channel.metadata.end() ? "" : found->second;
}

BagTopic topic_of(const mcap::Channel& channel, const mcap::Schema* schema) {
  BagTopic topic{.name = channel.topic,
                 .type = "",
                 .encoding = channel.message_encoding,
                 .qos = metadata_of(channel, "offered_qos_profiles"),
                 .type_hash = metadata_of(channel, "topic_type_hash")};
  if (schema == nullptr) return topic;
  topic.type = schema->name;
  topic.definition_encoding = schema->encoding;
  topic.definition = schema->data;
  return topic;
}

std::string describe(const mcap::Scan& scan) {
  std::string text;
  if (!scan.complete) text = fmt::format("torn after {} bytes", scan.good_bytes);
  if (scan.damaged == 0) return text;
  return fmt::format("{}{}{} of its parts are damaged and left out ({})", text, text.empty() ? "" : "; ",
                     scan.damaged, scan.fault);
}

}  // namespace

tl::expected<std::unique_ptr<Bag>, std::string> McapBag::open(const std::filesystem::path& file) {
  auto source = FileSource::open(file);
  if (!source) return tl::unexpected(source.error());
  return std::unique_ptr<Bag>(new McapBag(file, std::move(*source)));
}

tl::expected<BagScan, std::string> McapBag::scan(const Visit& visit) {
  std::map<std::uint16_t, BagTopic> topics;
  const auto scan = reader_.scan([&](const mcap::Message& message, const mcap::Channel& channel,
                                     const mcap::Schema* schema, const mcap::Place& place) {
    auto topic = topics.find(channel.id);
    if (topic == topics.end()) topic = topics.emplace(channel.id, topic_of(channel, schema)).first;
    visit(topic->second,
          {static_cast<std::int64_t>(message.log_time), static_cast<std::int64_t>(message.publish_time),
           message.data},
          {0, place.record, place.in_chunk});
  });
  if (!scan) return tl::unexpected(fmt::format("{}: {}", file_.string(), scan.error()));
  const std::string fault = describe(*scan);
  return BagScan{scan->messages, fault.empty() ? "" : fmt::format("{}: {}", file_.string(), fault)};
}

tl::expected<Bytes, std::string> McapBag::data_at(const BagPlace& place) const {
  auto data = reader_.data_at({place.record, place.in_chunk});
  if (!data) return tl::unexpected(fmt::format("{}: {}", file_.string(), data.error()));
  return data;
}

}  // namespace rds::recording
