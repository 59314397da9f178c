// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/core/foxglove/channels.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "common/map_file/byte_writer.hpp"

namespace rds::viewer::foxglove {
namespace {

using nlohmann::json;
constexpr std::uint8_t kMessageData = 1;

bool is_id(const json& value) {
  return value.is_number_unsigned() && value.get<std::uint64_t>() <= 0xffffffffU;
}

Said subscribe(const json& wanted, const std::vector<Channel>& channels, Subscriptions& subscriptions) {
  if (!wanted.is_object() || !wanted.contains("id") || !wanted.contains("channelId")) return Said::kRefused;
  if (!is_id(wanted["id"]) || !is_id(wanted["channelId"])) return Said::kRefused;
  const auto id = wanted["id"].get<std::uint32_t>();
  const auto channel = wanted["channelId"].get<std::uint32_t>();
  const bool is_offered = std::ranges::any_of(channels, [&](const Channel& c) { return c.id == channel; });
  const bool is_used = std::ranges::any_of(subscriptions, [&](const auto& s) { return s.second == id; });
  if (!is_offered || is_used || subscriptions.contains(channel)) return Said::kRefused;
  subscriptions.emplace(channel, id);
  return Said::kUnderstood;
}

Said unsubscribe(const json& id, Subscriptions& subscriptions) {
  if (!is_id(id)) return Said::kRefused;
  const std::size_t ended =
      std::erase_if(subscriptions, [&](const auto& s) { return s.second == id.get<std::uint32_t>(); });
  return ended > 0 ? Said::kUnderstood : Said::kRefused;
}

/// Does all elements of a list; refused if one is.
template <class Act>
Said each(const json& message, const char* key, Act act) {
  const auto list = message.find(key);
  if (list == message.end() || !list->is_array()) return Said::kRefused;
  Said said = Said::kUnderstood;
  for (const json& element : *list)
    if (act(element) == Said::kRefused) said = Said::kRefused;
  return said;
}

}  // namespace

std::string server_info(std::string_view session) {
  return json{{"op", "serverInfo"},
              {"name", "RDS-SLAM"},
              {"capabilities", json::array()},
              {"supportedEncodings", json::array()},
              {"metadata", json::object()},
              {"sessionId", session}}
      .dump();
}

std::string advertise(const std::vector<Channel>& channels) {
  json list = json::array();
  for (const Channel& channel : channels)
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", "cdr"},
                    {"schemaName", channel.schema_name},
                    {"schema", channel.schema},
                    {"schemaEncoding", "ros2msg"}});
  return json{{"op", "advertise"}, {"channels", list}}.dump();
}

Said take(std::string_view text, const std::vector<Channel>& channels, Subscriptions& subscriptions) {
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object() || !message.contains("op") || !message["op"].is_string()) return Said::kRefused;
  const auto op = message["op"].get<std::string>();
  if (op == "subscribe")
    return each(message, "subscriptions",
                [&](const json& wanted) { return subscribe(wanted, channels, subscriptions); });
  if (op == "unsubscribe")
    return each(message, "subscriptionIds", [&](const json& id) { return unsubscribe(id, subscriptions); });
  return Said::kRefused;
}

std::vector<std::uint8_t> message_data(std::uint32_t subscription, std::uint64_t time_ns,
                                       const std::vector<std::uint8_t>& message) {
  map_file::ByteWriter frame;
  frame.put(kMessageData);
  frame.put(subscription);
  frame.put(time_ns);
  frame.put_bytes(message);
  return frame.take();
}

}  // namespace rds::viewer::foxglove
