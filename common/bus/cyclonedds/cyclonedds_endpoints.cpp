// SPDX-License-Identifier: Apache-2.0
#include "common/bus/cyclonedds/cyclonedds_endpoints.hpp"

#include <array>
#include <memory>
#include <string_view>

#include "common/bus/dds/user_data.hpp"

namespace rds::bus::detail {
namespace {

struct DeleteListener {
  void operator()(dds_listener_t* listener) const { dds_delete_listener(listener); }
};

/// A reader of a built-in topic that calls `arrived` with `target` at each change.
dds_entity_t read_list(dds_entity_t participant, dds_entity_t topic, dds_on_data_available_fn arrived,
                       void* target) {
  const std::unique_ptr<dds_listener_t, DeleteListener> listener(dds_create_listener(target));
  dds_lset_data_available(listener.get(), arrived);
  return dds_create_reader(participant, topic, nullptr, listener.get());
}

bool is_reliable(const dds_qos_t* qos) {
  dds_reliability_kind_t kind{};
  return dds_qget_reliability(qos, &kind, nullptr) && kind == DDS_RELIABILITY_RELIABLE;
}

bool is_transient_local(const dds_qos_t* qos) {
  dds_durability_kind_t kind{};
  return dds_qget_durability(qos, &kind) && kind >= DDS_DURABILITY_TRANSIENT_LOCAL;
}

std::string type_hash_of(const dds_qos_t* qos) {
  void* data = nullptr;
  std::size_t size = 0;
  if (!dds_qget_userdata(qos, &data, &size) || data == nullptr) return {};
  std::string hash = type_hash_in({static_cast<const char*>(data), size});
  dds_free(data);
  return hash;
}

}  // namespace

CycloneEndpoints::CycloneEndpoints(dds_entity_t participant)
    : self_(guid_of(participant)),
      publications_(read_list(
                        participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION,
                        [](dds_entity_t list, void* self) {
                          static_cast<CycloneEndpoints*>(self)->take_all(list, true);
                        },
                        this),
                    "the list of publications"),
      subscriptions_(read_list(
                         participant, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION,
                         [](dds_entity_t list, void* self) {
                           static_cast<CycloneEndpoints*>(self)->take_all(list, false);
                         },
                         this),
                     "the list of subscriptions") {}

/// Takes, and does not only read: Cyclone DDS keeps what is left in the list, for ever.
void CycloneEndpoints::take_all(dds_entity_t list, bool publisher) {
  constexpr std::size_t kAtOnce = 16;
  std::array<void*, kAtOnce> samples{};  // nullptr: Cyclone DDS lends its own
  std::array<dds_sample_info_t, kAtOnce> infos{};
  for (;;) {
    const dds_return_t count = dds_take(list, samples.data(), infos.data(), kAtOnce, kAtOnce);
    if (count <= 0) return;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (infos[i].instance_state != DDS_IST_ALIVE) {
        directory_.remove(infos[i].instance_handle);
      } else if (infos[i].valid_data) {
        take(*static_cast<const dds_builtintopic_endpoint_t*>(samples[i]), infos[i].instance_handle,
             publisher);
      }
    }
    dds_return_loan(list, samples.data(), count);
  }
}

void CycloneEndpoints::take(const dds_builtintopic_endpoint_t& endpoint, dds_instance_handle_t handle,
                            bool publisher) {
  if (to_guid(endpoint.participant_key) == self_) return;
  directory_.put(
      handle,
      {endpoint.topic_name, endpoint.type_name, publisher, type_hash_of(endpoint.qos),
       text_of(to_guid(endpoint.key)), is_reliable(endpoint.qos), is_transient_local(endpoint.qos)},
      to_guid(endpoint.key));
}

}  // namespace rds::bus::detail
