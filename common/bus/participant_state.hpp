// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "common/bus/backend.hpp"

namespace rds::bus::detail {

class Endpoint;
class ServiceEndpoint;

inline std::unique_ptr<Backend> make_backend(const ParticipantOptions& options) {
  if (options.vendor == Vendor::kZenoh) return make_zenoh_backend(options);
  return as_ros_node(
      options.vendor == Vendor::kFastDds ? make_fastdds_backend(options) : make_cyclonedds_backend(options),
      options);
}

/// What a participant and its endpoints share; whoever of them lives longest closes it.
struct ParticipantState {
  explicit ParticipantState(const ParticipantOptions& options)
      : names(options.node_namespace, options.node_name, options.remappings),
        backend(make_backend(options)),
        identity(options.credentials ? options.credentials->identity : "") {}

  /// A participant carries one type per topic: both vendors would refuse a second one, each in its own way.
  void check_type(const std::string& topic, const TypeOps& type) {
    const std::lock_guard lock(mutex);
    const auto [known, added] = types.emplace(topic, type.dds_name);
    if (known->second == type.dds_name) return;
    throw BusError("topic " + topic + " already carries " + known->second + ", not " + type.dds_name);
  }

  /// Makes an endpoint. A vendor does not say that it was permissions that forbade it.
  template <class Make>
  auto explain_refusal(Make make) const {
    try {
      return make();
    } catch (const BusError& e) {
      if (identity.empty()) throw;
      throw BusError(std::string(e.what()) + ", which the permissions of '" + identity + "' must allow");
    }
  }

  TopicNames names;
  std::unique_ptr<Backend> backend;
  std::string identity;  // empty on an open bus
  std::mutex mutex;      // of what follows
  std::set<const Endpoint*> endpoints;
  std::set<const ServiceEndpoint*> services;
  std::map<std::string, std::string> types;  // by topic
};

/// What writers and readers have in common: what they are on the bus, and what has passed them.
class Endpoint {
 public:
  Endpoint(std::shared_ptr<ParticipantState> state, const std::string& topic, const TypeOps& type,
           const Qos& qos, bool publisher)
      : state_(std::move(state)),
        topic_(topic.starts_with('/') ? topic.substr(1) : topic),
        full_name_(state_->names.full_name(topic)),
        type_(type),
        qos_(qos),
        reliable_(qos.reliable),
        publisher_(publisher) {}
  Endpoint(const Endpoint&) = delete;
  Endpoint& operator=(const Endpoint&) = delete;

  [[nodiscard]] EndpointStatistics statistics() const {
    return {topic_, publisher_, messages_, bytes_, dropped_ + lost(), matched(), another_version_};
  }
  [[nodiscard]] DiscoveredEndpoint description() const {
    return {full_name_,      type_.dds_name, publisher_,          type_.type_hash,
            text_of(guid()), reliable_,      qos_.transient_local};
  }

 protected:
  ~Endpoint() = default;
  [[nodiscard]] virtual Guid guid() const = 0;
  [[nodiscard]] virtual int matched() const = 0;
  /// Messages that the bus itself has lost.
  [[nodiscard]] virtual std::uint64_t lost() const = 0;

  void enter() {
    const std::lock_guard lock(state_->mutex);
    state_->endpoints.insert(this);
  }
  void leave() {
    const std::lock_guard lock(state_->mutex);
    state_->endpoints.erase(this);
  }
  void count(std::size_t bytes) {
    ++messages_;
    bytes_ += bytes;
  }

  std::shared_ptr<ParticipantState> state_;
  std::string topic_;      // as it was asked for
  std::string full_name_;  // on the bus, without "rt/"
  const TypeOps& type_;
  Qos qos_;
  std::atomic<bool> reliable_;  // a reader may have to ask for less than its QoS says
  bool publisher_;
  std::atomic<std::uint64_t> messages_ = 0;
  std::atomic<std::uint64_t> bytes_ = 0;
  std::atomic<std::uint64_t> dropped_ = 0;
  std::atomic<std::uint64_t> another_version_ = 0;  // of these
};

}  // namespace rds::bus::detail
