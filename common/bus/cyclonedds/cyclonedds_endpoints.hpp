// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include "common/bus/cyclonedds/cyclonedds_entity.hpp"
#include "common/bus/endpoint_directory.hpp"

namespace rds::bus::detail {

/// Keeps a directory of the endpoints that Cyclone DDS announces on its built-in topics. It does so before it
/// matches an endpoint, on the thread that will match it, so no sample comes from a writer that is not
/// listed.
class CycloneEndpoints {
 public:
  /// @throws BusError
  explicit CycloneEndpoints(dds_entity_t participant);

  /// By the handle that samples have as publication_handle.
  [[nodiscard]] const EndpointDirectory<dds_instance_handle_t>& directory() const { return directory_; }
  /// @param handle  publication_handle of a sample.
  [[nodiscard]] ParticipantId participant_of_writer(dds_instance_handle_t handle) const {
    return participant_of(directory_.guid_of(handle).value_or(self_));  // our own are not listed
  }

 private:
  void take_all(dds_entity_t list, bool publisher);
  void take(const dds_builtintopic_endpoint_t& endpoint, dds_instance_handle_t handle, bool publisher);

  Guid self_;
  EndpointDirectory<dds_instance_handle_t> directory_;
  Entity publications_;
  Entity subscriptions_;
};

}  // namespace rds::bus::detail
