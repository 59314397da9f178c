// SPDX-License-Identifier: Apache-2.0
#include "common/messages/registry.hpp"

#include <algorithm>

namespace rds::messages {

/// Generated: appends every type of idl/.
void add_all_types(std::vector<MessageType>& types);

namespace {

std::vector<MessageType> sorted_types() {
  std::vector<MessageType> types;
  add_all_types(types);
  std::ranges::sort(types, {},
                    [](const MessageType& type) -> const std::string& { return type.ops->dds_name; });
  return types;
}

}  // namespace

std::span<const MessageType> message_types() {
  static const std::vector<MessageType> kTypes = sorted_types();
  return kTypes;
}

const MessageType* find_message_type(std::string_view dds_name) {
  const auto name = [](const MessageType& type) -> std::string_view { return type.ops->dds_name; };
  const auto types = message_types();
  const auto found = std::ranges::lower_bound(types, dds_name, {}, name);
  return found != types.end() && name(*found) == dds_name ? &*found : nullptr;
}

}  // namespace rds::messages
