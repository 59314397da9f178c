// SPDX-License-Identifier: Apache-2.0
#include <dds/dds.h>

#include "common/bus/backend.hpp"
#include "common/bus/cyclonedds/cyclonedds_discovery.hpp"
#include "common/bus/cyclonedds/cyclonedds_domain.hpp"
#include "common/bus/cyclonedds/cyclonedds_endpoints.hpp"
#include "common/bus/cyclonedds/cyclonedds_reader.hpp"
#include "common/bus/cyclonedds/cyclonedds_service.hpp"
#include "common/bus/cyclonedds/cyclonedds_type.hpp"
#include "common/bus/cyclonedds/cyclonedds_writer.hpp"
#include "common/bus/cyclonedds/request_header.hpp"
#include "common/bus/dds/security_properties.hpp"
#include "common/bus/dds/service_topics.hpp"
#include "common/bus/dds/user_data.hpp"

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
    return make_cyclone_writer(topic, type, qos);
  }
  std::unique_ptr<BackendReader> make_reader(const std::string& topic, const TypeOps& type,
                                             const Qos& qos) override {
    return make_cyclone_reader(topic, type, qos);
  }
  std::unique_ptr<BackendService> make_service(const std::string& name, const ServiceType& type) override {
    return make_cyclonedds_service(
        make_cyclone_reader(request_topic(name), as_bytes(type.request), kServiceQos),
        make_cyclone_writer(reply_topic(name), as_bytes(type.response), kServiceQos), type.response);
  }
  [[nodiscard]] Guid guid() const override { return guid_of(participant_.get()); }

  [[nodiscard]] std::vector<DiscoveredEndpoint> discovered() const override {
    return endpoints_.directory().endpoints();
  }

 private:
  std::unique_ptr<CycloneWriter> make_cyclone_writer(const std::string& topic, const TypeOps& type,
                                                     const Qos& qos) {
    const Entity entity(make_topic(topic, type), "topic " + topic + " of type " + type.dds_name);
    return std::make_unique<CycloneWriter>(participant_.get(), entity.get(), topic,
                                           endpoint_qos(type, qos).get());
  }
  std::unique_ptr<CycloneReader> make_cyclone_reader(const std::string& topic, const TypeOps& type,
                                                     const Qos& qos) {
    const Entity entity(make_topic(topic, type), "topic " + topic + " of type " + type.dds_name);
    return std::make_unique<CycloneReader>(
        participant_.get(), entity.get(), topic, endpoint_qos(type, qos).get(), endpoints_,
        VersionCheck<dds_instance_handle_t>(endpoints_.directory(), topic, type));
  }

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
