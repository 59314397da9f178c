// SPDX-License-Identifier: Apache-2.0
#include "common/bus/cyclonedds/request_header.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <map>
#include <mutex>
#include <string>

namespace rds::bus::detail {
namespace {

constexpr std::ptrdiff_t kEncapsulationSize = 4;
constexpr std::ptrdiff_t kNumberSize = 8;
constexpr std::ptrdiff_t kHeaderSize = 2 * kNumberSize;

std::uint64_t read_number(const std::uint8_t* bytes, bool little_endian) {
  std::uint64_t number = 0;
  for (std::ptrdiff_t i = 0; i < kNumberSize; ++i)
    number = number << 8U | bytes[little_endian ? kNumberSize - 1 - i : i];
  return number;
}

void write_number(std::uint64_t number, std::uint8_t* bytes) {
  for (std::ptrdiff_t i = 0; i < kNumberSize; ++i) bytes[i] = static_cast<std::uint8_t>(number >> (8 * i));
}

const MessageBytes& bytes_of(const void* message) {
  return *static_cast<const MessageBytes*>(message);
}

std::size_t copy(const void* message, std::uint8_t* bytes, std::size_t capacity) {
  const MessageBytes& source = bytes_of(message);
  if (source.size() > capacity) return 0;
  std::ranges::copy(source, bytes);
  return source.size();
}

}  // namespace

std::optional<RequestHeader> take_header(MessageBytes& bytes) {
  if (bytes.size() < kEncapsulationSize + kHeaderSize || bytes[0] != 0 || bytes[1] > 1) return std::nullopt;
  const bool little_endian = bytes[1] == 1;
  const std::uint8_t* header = bytes.data() + kEncapsulationSize;
  const RequestHeader result{read_number(header, little_endian),
                             static_cast<std::int64_t>(read_number(header + kNumberSize, little_endian))};
  bytes.erase(bytes.begin() + kEncapsulationSize, bytes.begin() + kEncapsulationSize + kHeaderSize);
  return result;
}

MessageBytes encode_with_header(const RequestHeader& header, const TypeOps& type, const void* message) {
  MessageBytes bytes(kHeaderSize + type.encoded_size(message));
  std::uint8_t* encoded = bytes.data() + kHeaderSize;
  if (type.encode(message, encoded, bytes.size() - kHeaderSize) == 0) return {};
  std::copy_n(encoded, kEncapsulationSize, bytes.data());
  write_number(header.client, bytes.data() + kEncapsulationSize);
  write_number(static_cast<std::uint64_t>(header.sequence), bytes.data() + kEncapsulationSize + kNumberSize);
  return bytes;
}

const TypeOps& as_bytes(const TypeOps& type) {
  static std::mutex mutex;
  static std::map<std::string, TypeOps> types;
  const std::lock_guard lock(mutex);
  const auto [known, is_new] = types.try_emplace(type.dds_name, type);
  if (is_new) {
    known->second.encoded_size = [](const void* message) { return bytes_of(message).size(); };
    known->second.encode = &copy;
    known->second.decode = [](const std::uint8_t* bytes, std::size_t size, void* message) {
      static_cast<MessageBytes*>(message)->assign(bytes, bytes + size);
      return true;
    };
    known->second.create = []() -> void* { return new MessageBytes; };
    known->second.destroy = [](void* message) { delete static_cast<MessageBytes*>(message); };
  }
  return known->second;
}

}  // namespace rds::bus::detail
