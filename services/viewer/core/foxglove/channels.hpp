// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace rds::viewer::foxglove {

/// The same frames under two names: Foxglove's newer clients offer the first.
inline const std::vector<std::string> kProtocols{"foxglove.sdk.v1", "foxglove.websocket.v1"};

/// A topic as it is offered: message encoding "cdr", schema encoding "ros2msg".
struct Channel {
  std::uint32_t id = 0;
  std::string topic;        // "/rds/odometry"
  std::string schema_name;  // "nav_msgs/msg/Odometry"
  std::string schema;       // definition with all that it contains
};

/// The first message to a client: no capability, so clients neither publish, call nor set anything.
std::string server_info(std::string_view session);
std::string advertise(const std::vector<Channel>& channels);

/// A client's subscriptions: the id that it has chosen, by channel.
using Subscriptions = std::map<std::uint32_t, std::uint32_t>;

enum class Said { kUnderstood, kRefused };

/// Takes a text message of the client (subscribe, unsubscribe) into its subscriptions. Unknown operations are
/// refused; so are channels that are not offered, a second subscription of a channel, and an id in use.
Said take(std::string_view message, const std::vector<Channel>& channels, Subscriptions& subscriptions);

/// Binary frame 0x01: subscription, time, the message as it is.
std::vector<std::uint8_t> message_data(std::uint32_t subscription, std::uint64_t time_ns,
                                       const std::vector<std::uint8_t>& message);

}  // namespace rds::viewer::foxglove
