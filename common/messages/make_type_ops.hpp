// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <span>

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include "common/bus/type_ops.hpp"
#include "common/messages/cdr_check.hpp"
#include "common/messages/fields.hpp"

/// The definition of type_ops(); only the generated sources include it and instantiate it for every type.
namespace rds::bus {
namespace detail {

inline constexpr std::size_t kEncapsulationSize = 4;

template <class T>
std::size_t encoded_size(const void* message) {
  return kEncapsulationSize + T::getCdrSerializedSize(*static_cast<const T*>(message));
}

template <class T>
std::size_t encode(const void* message, std::uint8_t* bytes, std::size_t capacity) {
  namespace fastcdr = eprosima::fastcdr;
  try {
    fastcdr::FastBuffer buffer(reinterpret_cast<char*>(bytes), capacity);
    fastcdr::Cdr cdr(buffer, fastcdr::Cdr::LITTLE_ENDIANNESS, fastcdr::Cdr::DDS_CDR);
    cdr.serialize_encapsulation();
    static_cast<const T*>(message)->serialize(cdr);
    const std::size_t size = cdr.getSerializedDataLength();
    messages::clear_padding(std::span(bytes, size), messages::Fields<T>::kLayout);
    return size;
  } catch (const fastcdr::exception::Exception&) {
    return 0;  // does not fit
  }
}

template <class T>
bool decode(const std::uint8_t* bytes, std::size_t size, void* message) {
  namespace fastcdr = eprosima::fastcdr;
  if (!messages::is_well_formed(std::span(bytes, size), messages::Fields<T>::kLayout)) return false;
  try {
    // FastBuffer only reads here; it has no constructor for const memory.
    fastcdr::FastBuffer buffer(reinterpret_cast<char*>(const_cast<std::uint8_t*>(bytes)), size);
    fastcdr::Cdr cdr(buffer, fastcdr::Cdr::DEFAULT_ENDIAN, fastcdr::Cdr::DDS_CDR);
    cdr.read_encapsulation();
    static_cast<T*>(message)->deserialize(cdr);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace detail

template <class T>
const TypeOps& type_ops() {
  static const TypeOps kOps{
      .dds_name = messages::Fields<T>::kDdsName,
      .ros_name = messages::Fields<T>::kRosName,
      .type_hash = messages::Fields<T>::kTypeHash,
      .encoded_size = &detail::encoded_size<T>,
      .encode = &detail::encode<T>,
      .decode = &detail::decode<T>,
      .create = []() -> void* { return new T; },
      .destroy = [](void* message) { delete static_cast<T*>(message); },
  };
  return kOps;
}

}  // namespace rds::bus
