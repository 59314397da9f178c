// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/bus/type_ops.hpp"

namespace rds::keyframe_transfer {

/// A message as an item of a transfer: as it would be on the bus.
template <class Message>
std::vector<std::uint8_t> bytes_of(const Message& message) {
  const bus::TypeOps& type = bus::type_ops<Message>();
  std::vector<std::uint8_t> bytes(type.encoded_size(&message));
  bytes.resize(type.encode(&message, bytes.data(), bytes.size()));
  return bytes;
}

/// @return null for bytes that are no such message.
template <class Message>
std::shared_ptr<Message> message_of(std::span<const std::uint8_t> bytes) {
  auto message = std::make_shared<Message>();
  if (!bus::type_ops<Message>().decode(bytes.data(), bytes.size(), message.get())) return nullptr;
  return message;
}

}  // namespace rds::keyframe_transfer
