// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include "common/bus/cyclonedds/cyclonedds_endpoints.hpp"

namespace rds::bus::detail {

struct UnrefMessage {
  void operator()(ddsi_serdata* message) const { ddsi_serdata_unref(message); }
};

/// A reader of any type; takes what a wait set has told of.
class CycloneReader final : public BackendReader {
 public:
  CycloneReader(dds_entity_t participant, dds_entity_t topic, const std::string& name, const dds_qos_t* qos,
                const CycloneEndpoints& endpoints, VersionCheck<dds_instance_handle_t> versions)
      : endpoints_(endpoints),
        versions_(std::move(versions)),
        reader_(dds_create_reader(participant, topic, qos, nullptr), "a reader on " + name),
        readable_(dds_create_readcondition(reader_.get(), DDS_ANY_STATE), "a condition"),
        stop_(dds_create_guardcondition(participant), "a condition"),
        wait_set_(dds_create_waitset(participant), "a wait set") {
    dds_waitset_attach(wait_set_.get(), readable_.get(), 0);
    dds_waitset_attach(wait_set_.get(), stop_.get(), 0);
  }

  void wait() override { dds_waitset_wait(wait_set_.get(), nullptr, 0, DDS_INFINITY); }
  bool wait_for(std::chrono::seconds limit) override {
    return dds_waitset_wait(wait_set_.get(), nullptr, 0, DDS_SECS(limit.count())) != 0;
  }
  void wake() override { dds_set_guardcondition(stop_.get(), true); }
  bool take(Sample& sample) override {
    ddsi_serdata* message = nullptr;
    dds_sample_info_t info{};
    while (dds_takecdr(reader_.get(), &message, 1, &info, DDS_ANY_STATE) > 0) {
      const std::unique_ptr<ddsi_serdata, UnrefMessage> held(message);
      if (!info.valid_data) continue;
      sample.writer = endpoints_.participant_of_writer(info.publication_handle);
      sample.another_version = versions_.others().contains(info.publication_handle);
      if (!sample.another_version) ddsi_serdata_to_sample(message, &sample, nullptr, nullptr);
      return true;
    }
    return false;
  }
  [[nodiscard]] std::uint64_t lost() const override {
    dds_sample_lost_status_t status{};
    dds_get_sample_lost_status(reader_.get(), &status);
    return status.total_count;
  }
  [[nodiscard]] int matched() const override {
    dds_subscription_matched_status_t status{};
    dds_get_subscription_matched_status(reader_.get(), &status);
    return static_cast<int>(status.current_count);
  }
  [[nodiscard]] Guid guid() const override { return guid_of(reader_.get()); }

 private:
  const CycloneEndpoints& endpoints_;
  VersionCheck<dds_instance_handle_t> versions_;
  Entity reader_;
  Entity readable_;
  Entity stop_;
  Entity wait_set_;
};

}  // namespace rds::bus::detail
