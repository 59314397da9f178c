// SPDX-License-Identifier: Apache-2.0
#include "common/bus/participant.hpp"

#include <algorithm>

#include <malloc.h>

#include "common/bus/participant_endpoints.hpp"
#include "common/bus/server_endpoint.hpp"
#include "common/bus/type_version.hpp"

namespace rds::bus {
namespace {

using detail::Endpoint;

constexpr int kHighestDomain = 232;  // RTPS port numbers end there

class BusParticipant final : public Participant, public detail::ServiceHost {
 public:
  explicit BusParticipant(const ParticipantOptions& options)
      : state_(std::make_shared<detail::ParticipantState>(options)) {}

  std::unique_ptr<detail::PublisherEndpoint> make_publisher(const std::string& topic, const TypeOps& type,
                                                            const Qos& qos) override {
    state_->check_type(full_name(topic), type);
    return state_->explain_refusal(
        [&] { return std::make_unique<detail::WriterEndpoint>(state_, topic, type, qos); });
  }

  std::unique_ptr<detail::SubscriptionEndpoint> make_subscription(
      const std::string& topic, const TypeOps& type, const Qos& qos,
      std::function<void(std::shared_ptr<const void>, const ParticipantId&)> callback) override {
    state_->check_type(full_name(topic), type);
    return state_->explain_refusal([&] {
      return std::make_unique<detail::ReaderEndpoint>(state_, topic, type, qos, std::move(callback));
    });
  }

  std::unique_ptr<detail::ServiceEndpoint> make_service(const std::string& name, const ServiceType& type,
                                                        detail::ServiceHandler handler) override {
    return state_->explain_refusal([&] {
      return std::make_unique<detail::ServerEndpoint>(state_, full_name(name), type, std::move(handler));
    });
  }

  [[nodiscard]] ParticipantId id() const override { return detail::participant_of(state_->backend->guid()); }

  [[nodiscard]] std::string full_name(const std::string& topic) const override {
    return state_->names.full_name(topic);
  }

  [[nodiscard]] std::vector<EndpointStatistics> statistics() const override {
    std::vector<EndpointStatistics> result;
    const std::lock_guard lock(state_->mutex);
    for (const Endpoint* endpoint : state_->endpoints) result.push_back(endpoint->statistics());
    for (const detail::ServiceEndpoint* service : state_->services)
      if (auto asked = service->statistics(); asked.messages + asked.dropped > 0)
        result.push_back(std::move(asked));
    std::ranges::sort(result, {},
                      [](const EndpointStatistics& s) { return std::pair(s.topic, s.publisher); });
    return result;
  }

  [[nodiscard]] std::vector<DiscoveredEndpoint> discovered() const override {
    std::vector<DiscoveredEndpoint> result = others();
    std::ranges::move(own(), std::back_inserter(result));
    std::ranges::sort(result, {},
                      [](const DiscoveredEndpoint& e) { return std::tuple(e.topic, e.publisher, e.type); });
    return result;
  }

  [[nodiscard]] std::vector<Mismatch> mismatches() const override {
    std::map<std::string, DiscoveredEndpoint> ours;  // any of a topic's endpoints: they carry one type
    for (DiscoveredEndpoint& endpoint : own()) ours.emplace(endpoint.topic, std::move(endpoint));
    std::vector<Mismatch> result;
    for (DiscoveredEndpoint& endpoint : others()) {
      const auto same_topic = ours.find(endpoint.topic);
      if (same_topic == ours.end() || !detail::is_another_version(same_topic->second, endpoint)) continue;
      result.push_back({std::move(endpoint), same_topic->second.type_hash});
    }
    return result;
  }

 private:
  [[nodiscard]] std::vector<DiscoveredEndpoint> own() const {
    const std::lock_guard lock(state_->mutex);
    std::vector<DiscoveredEndpoint> result;
    for (const Endpoint* endpoint : state_->endpoints) result.push_back(endpoint->description());
    return result;
  }
  [[nodiscard]] std::vector<DiscoveredEndpoint> others() const { return state_->backend->discovered(); }

  std::shared_ptr<detail::ParticipantState> state_;
};

/// @throws BusError for what no participant can be made of.
void check(const ParticipantOptions& options) {
  if (options.domain < 0 || options.domain > kHighestDomain) {
    throw BusError("domain " + std::to_string(options.domain) + ", expected 0 to " +
                   std::to_string(kHighestDomain));
  }
  if (options.credentials && options.domain > kHighestSecuredDomain)
    throw BusError("DDS domain " + std::to_string(options.domain) + ", expected 0 to " +
                   std::to_string(kHighestSecuredDomain) + " for a secured one");
  if (options.vendor == Vendor::kZenoh) return;
  for (const std::string& peer : options.peers)
    if (peer.find('/') != std::string::npos)
      throw BusError("peer '" + peer + "': an endpoint of Zenoh, expected a name or an address with --bus " +
                     name_of(options.vendor));
}

/// Lets freed memory stay with the process. By itself the C library adapts to large messages only by chance:
/// in some runs it gives every picture's memory back to the kernel, which has to clear it for the next one,
/// and a picture's way takes more than twice as long.
void keep_freed_memory() {
  constexpr int kMiB = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * kMiB);
  mallopt(M_TRIM_THRESHOLD, 64 * kMiB);
}

}  // namespace

Vendor vendor_from_name(const std::string& name) {
  const auto known = std::ranges::find(kVendorNames, name);
  if (known == kVendorNames.end())
    throw std::invalid_argument("bus '" + name + "', expected " + kVendorChoice);
  return static_cast<Vendor>(known - kVendorNames.begin());
}

std::string name_of(Vendor vendor) {
  return kVendorNames.at(static_cast<std::size_t>(vendor));
}

RosDistro ros_distro_from_name(const std::string& name) {
  const bool is_old = name == "foxy" || name == "galactic" || name == "humble";
  return is_old ? RosDistro::kHumble : RosDistro::kJazzy;
}

std::unique_ptr<Participant> Participant::create(const ParticipantOptions& options) {
  check(options);
  keep_freed_memory();
  try {
    return std::make_unique<BusParticipant>(options);
  } catch (const std::invalid_argument& e) {  // of a name
    throw BusError(e.what());
  }
}

}  // namespace rds::bus
