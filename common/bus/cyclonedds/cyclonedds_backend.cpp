// SPDX-License-Identifier: Apache-2.0
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include "common/bus/backend.hpp"
#include "common/bus/cyclonedds/cyclonedds_discovery.hpp"
#include "common/bus/cyclonedds/cyclonedds_domain.hpp"
#include "common/bus/cyclonedds/cyclonedds_endpoints.hpp"
#include "common/bus/cyclonedds/cyclonedds_type.hpp"
#include "common/bus/dds/user_data.hpp"
#include "common/bus/security_properties.hpp"

namespace rds::bus::detail {
namespace {

struct DeleteQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using QosPtr = std::unique_ptr<dds_qos_t, DeleteQos>;

QosPtr participant_qos(const ParticipantOptions& options) {
  QosPtr qos(dds_create_qos());
  const std::string user_data = kParticipantUserData;
  dds_qset_userdata(qos.get(), user_data.data(), user_data.size());
  dds_qset_entity_name(qos.get(), options.node_name.c_str());
  if (options.credentials)
    for (const auto& [name, value] : cyclonedds_security(*options.credentials))
      dds_qset_prop(qos.get(), name.c_str(), value.c_str());
  return qos;
}

QosPtr endpoint_qos(const TypeOps& type, const Qos& qos) {
  QosPtr target(dds_create_qos());
  // A blocking time of 0: a writer never waits.
  dds_qset_reliability(target.get(), qos.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       0);
  dds_qset_durability(target.get(),
                      qos.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  const int depth = history_depth(qos);
  dds_qset_history(target.get(), DDS_HISTORY_KEEP_LAST, depth);
  if (qos.transient_local) {
    dds_qset_durability_service(target.get(), 0, DDS_HISTORY_KEEP_LAST, depth, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  const std::string user_data = endpoint_user_data(type);
  dds_qset_userdata(target.get(), user_data.data(), user_data.size());
  return target;
}

struct Unref {
  void operator()(ddsi_serdata* message) const { ddsi_serdata_unref(message); }
};

class CycloneWriter final : public BackendWriter {
 public:
  CycloneWriter(dds_entity_t participant, dds_entity_t topic, const std::string& name, const QosPtr& qos)
      : writer_(dds_create_writer(participant, topic, qos.get(), nullptr), "a writer on " + name) {}

  bool write(const void* message) override { return dds_write(writer_.get(), message) == DDS_RETCODE_OK; }
  [[nodiscard]] int matched() const override {
    dds_publication_matched_status_t status{};
    dds_get_publication_matched_status(writer_.get(), &status);
    return static_cast<int>(status.current_count);
  }
  [[nodiscard]] Guid guid() const override { return guid_of(writer_.get()); }

 private:
  Entity writer_;
};

class CycloneReader final : public BackendReader {
 public:
  CycloneReader(dds_entity_t participant, dds_entity_t topic, const std::string& name, const QosPtr& qos,
                const CycloneEndpoints& endpoints, VersionCheck<dds_instance_handle_t> versions)
      : endpoints_(endpoints),
        versions_(std::move(versions)),
        reader_(dds_create_reader(participant, topic, qos.get(), nullptr), "a reader on " + name),
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
      const std::unique_ptr<ddsi_serdata, Unref> held(message);
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

class CycloneBackend final : public Backend {
 public:
  explicit CycloneBackend(const ParticipantOptions& options)
      : domain_(join_cyclonedds_domain(options)),
        participant_(dds_create_participant(static_cast<dds_domainid_t>(options.domain),
                                            participant_qos(options).get(), nullptr),
                     "a participant in domain " + std::to_string(options.domain)),
        endpoints_(participant_.get()) {
    if (!cyclonedds_discovery_is_filtered()) {
      throw BusError(
          "this build of Cyclone DDS reads type information from anybody: expected Debian 12's 0.10");
    }
  }

  std::unique_ptr<BackendWriter> make_writer(const std::string& topic, const TypeOps& type,
                                             const Qos& qos) override {
    const Entity entity(make_topic(topic, type), "topic " + topic + " of type " + type.dds_name);
    return std::make_unique<CycloneWriter>(participant_.get(), entity.get(), topic, endpoint_qos(type, qos));
  }
  std::unique_ptr<BackendReader> make_reader(const std::string& topic, const TypeOps& type,
                                             const Qos& qos) override {
    const Entity entity(make_topic(topic, type), "topic " + topic + " of type " + type.dds_name);
    return std::make_unique<CycloneReader>(
        participant_.get(), entity.get(), topic, endpoint_qos(type, qos), endpoints_,
        VersionCheck<dds_instance_handle_t>(endpoints_.directory(), topic, type));
  }
  [[nodiscard]] Guid guid() const override { return guid_of(participant_.get()); }

  [[nodiscard]] std::vector<DiscoveredEndpoint> discovered() const override {
    return endpoints_.directory().endpoints();
  }

 private:
  /// Topics are counted by Cyclone DDS: an endpoint keeps its topic alive.
  dds_entity_t make_topic(const std::string& name, const TypeOps& type) {
    ddsi_sertype* carried = make_cyclonedds_type(type);
    const dds_entity_t topic =
        dds_create_topic_sertype(participant_.get(), name.c_str(), &carried, nullptr, nullptr, nullptr);
    if (topic < 0) ddsi_sertype_unref(carried);
    return topic;
  }

  std::shared_ptr<void> domain_;
  Entity participant_;
  CycloneEndpoints endpoints_;
};

}  // namespace

std::unique_ptr<Backend> make_cyclonedds_backend(const ParticipantOptions& options) {
  return std::make_unique<CycloneBackend>(options);
}

}  // namespace rds::bus::detail
