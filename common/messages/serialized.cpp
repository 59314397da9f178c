// SPDX-License-Identifier: Apache-2.0
#include "common/messages/serialized.hpp"

#include <algorithm>

namespace rds::messages {
namespace {

constexpr std::size_t kEncapsulationBytes = 4;

const std::vector<std::uint8_t>& bytes_of(const void* message) {
  return static_cast<const SerializedMessage*>(message)->bytes;
}

}  // namespace

bus::TypeOps serialized(const bus::TypeOps& type) {
  bus::TypeOps ops = type;
  ops.encoded_size = [](const void* message) { return bytes_of(message).size(); };
  ops.encode = [](const void* message, std::uint8_t* target, std::size_t capacity) -> std::size_t {
    const auto& bytes = bytes_of(message);
    if (bytes.size() > capacity) return 0;
    std::ranges::copy(bytes, target);
    return bytes.size();
  };
  ops.decode = [](const std::uint8_t* bytes, std::size_t size, void* message) {
    static_cast<SerializedMessage*>(message)->bytes.assign(bytes, bytes + size);
    return size >= kEncapsulationBytes;
  };
  ops.create = []() -> void* { return new SerializedMessage; };
  ops.destroy = [](void* message) { delete static_cast<SerializedMessage*>(message); };
  return ops;
}

}  // namespace rds::messages
