// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace rds::bus {

/// What a back end needs to carry a message type: its names and its CDR (XCDR1, little-endian) codec.
struct TypeOps {
  std::string dds_name;   // "nav_msgs::msg::dds_::Odometry_"
  std::string ros_name;   // "nav_msgs/msg/Odometry"
  std::string type_hash;  // "RIHS01_<64 hex>"
  /// Bytes of the encoded message, with the 4-byte encapsulation header.
  std::size_t (*encoded_size)(const void* message);
  /// @return bytes written; 0 if it does not fit.
  std::size_t (*encode)(const void* message, std::uint8_t* bytes, std::size_t capacity);
  /// @return false for torn or hostile bytes; never throws, never allocates more than the bytes can hold.
  bool (*decode)(const std::uint8_t* bytes, std::size_t size, void* message);
  void* (*create)();
  void (*destroy)(void* message);
};

/// The operations of a message type; specialised for every type of idl/ by common/messages.
template <class T>
const TypeOps& type_ops();

}  // namespace rds::bus
