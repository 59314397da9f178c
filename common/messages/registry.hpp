// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/bus/type_ops.hpp"
#include "common/messages/json.hpp"

namespace rds::messages {

/// A message type that is chosen at run time.
struct MessageType {
  const bus::TypeOps* ops;
  Json (*to_json)(const void* message);
  tl::expected<void, std::string> (*from_json)(const Json& json, void* message);
};

/// All types of idl/, by DDS name.
std::span<const MessageType> message_types();

/// @param dds_name  e.g. "nav_msgs::msg::dds_::Odometry_". @return nullptr if no IDL file defines it.
const MessageType* find_message_type(std::string_view dds_name);

/// The entry of a type known at compile time.
template <class Message>
MessageType message_type() {
  return {&bus::type_ops<Message>(),
          [](const void* message) { return to_json(*static_cast<const Message*>(message)); },
          [](const Json& json, void* message) { return from_json(json, *static_cast<Message*>(message)); }};
}

}  // namespace rds::messages
