// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <iterator>
#include <string>

#include <dds/dds.h>

#include "common/bus/backend.hpp"

namespace rds::bus::detail {

/// An entity of Cyclone DDS, deleted with its children.
class Entity {
 public:
  /// @throws BusError for a `handle` that says an error.
  Entity(dds_entity_t handle, const std::string& what) : handle_(handle) {
    if (handle < 0) throw BusError("Cyclone DDS refused " + what + ": " + dds_strretcode(handle));
  }
  ~Entity() { dds_delete(handle_); }
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;
  [[nodiscard]] dds_entity_t get() const { return handle_; }

 private:
  dds_entity_t handle_;
};

inline Guid to_guid(const dds_guid_t& source) {
  Guid guid{};
  std::copy(std::begin(source.v), std::end(source.v), guid.begin());
  return guid;
}

inline Guid guid_of(dds_entity_t entity) {
  dds_guid_t source{};
  dds_get_guid(entity, &source);
  return to_guid(source);
}

}  // namespace rds::bus::detail
