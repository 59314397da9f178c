// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <dds/dds.h>

#include "common/bus/cyclonedds/cyclonedds_entity.hpp"

namespace rds::bus::detail {

/// A writer of any type.
class CycloneWriter final : public BackendWriter {
 public:
  CycloneWriter(dds_entity_t participant, dds_entity_t topic, const std::string& name, const dds_qos_t* qos)
      : writer_(dds_create_writer(participant, topic, qos, nullptr), "a writer on " + name) {}

  bool write(const void* message) override { return dds_write(writer_.get(), message) == DDS_RETCODE_OK; }
  [[nodiscard]] int matched() const override {
    dds_publication_matched_status_t status{};
    dds_get_publication_matched_status(writer_.get(), &status);
    return static_cast<int>(status.current_count);
  }
  [[nodiscard]] Guid guid() const override { return guid_of(writer_.get()); }
  [[nodiscard]] dds_entity_t entity() const { return writer_.get(); }

 private:
  Entity writer_;
};

}  // namespace rds::bus::detail
