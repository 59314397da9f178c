// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>
#include <tl/expected.hpp>

namespace rds::messages {

/// Keeps the members in wire order.
using Json = nlohmann::ordered_json;

/// Any nlohmann JSON as text; bytes that are not UTF-8 become U+FFFD, so that it never throws.
template <class AnyJson>
std::string to_text(const AnyJson& json, int indent = -1) {
  return json.dump(indent, ' ', false, AnyJson::error_handler_t::replace);
}

/// The message as an object with its members in wire order. A float that is NaN or infinite becomes null.
/// Instantiated for every IDL type.
template <class Message>
Json to_json(const Message& message);

/// Sets the members of `message` that the object names; null sets a float to NaN.
///
/// @return what is wrong, with the path of the member, e.g. "header.stamp.sec: 5000000000 is out of range";
/// members
///         before it are already set.
template <class Message>
tl::expected<void, std::string> from_json(const Json& json, Message& message);

}  // namespace rds::messages
