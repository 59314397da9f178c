// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace rds::messages {

/// A message type as text, as recordings carry it (schema encoding "ros2msg"): the lines of its .msg file
/// without comments, then, each behind a line of 80 '=' and "MSG: package/Name", those of the types that it
/// contains.
struct Definition {
  std::string_view ros_name;  // "sensor_msgs/msg/Image"
  std::string_view text;
};

/// Of all types of idl/, by name. Generated.
std::span<const Definition> definitions();

/// The text of one type; empty if no IDL file defines it.
std::string_view definition_of(std::string_view ros_name);

}  // namespace rds::messages
