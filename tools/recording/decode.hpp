// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "common/bus/type_ops.hpp"

namespace rds::recording {

/// A message of a bag. @return nullptr if it is torn, or of another type.
template <class Message>
std::shared_ptr<Message> decode(std::span<const std::uint8_t> data) {
  auto message = std::make_shared<Message>();
  if (!bus::type_ops<Message>().decode(data.data(), data.size(), message.get())) return nullptr;
  return message;
}

}  // namespace rds::recording
