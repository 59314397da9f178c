// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/zenoh_settings.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace rds::bus::detail {
namespace {

constexpr int kRouterPort = 7447;    // Zenoh's own
constexpr int kScoutingPort = 7000;  // plus the domain; below RTPS' ports and apart from Zenoh's 7446
/// What a session waits for to know the others before it is used: a reader asks for what was written before
/// when it is made, and what it hears before it could ask would stand for all.
constexpr int kFindingMs = 250;
constexpr int kLeaseMs = 10'000;           // of a silent link: as with DDS
constexpr int kWaitBeforeDropUs = 10'000;  // of a sending thread for a reader that does not keep up
/// Of what must not be dropped, as declarations; then the link goes.
constexpr int kWaitBeforeCloseUs = 10'000'000;
/// Parts of 64 kB that may wait on a link in the class of pictures, for a reader that is not scheduled for a
/// while.
constexpr int kPictureBatches = 16;
constexpr int kLargestMessage = 256 << 20;  // bytes

/// A name or address is that machine's router, or whoever listens in its place.
std::string endpoint_of(const std::string& peer) {
  return peer.find('/') == std::string::npos ? fmt::format("tcp/{}:{}", peer, kRouterPort) : peer;
}

std::vector<std::string> connected(const ParticipantOptions& options) {
  if (options.loopback_only) return {};
  if (options.peers.empty()) return {endpoint_of("127.0.0.1")};
  std::vector<std::string> endpoints;
  for (const std::string& peer : options.peers) endpoints.push_back(endpoint_of(peer));
  return endpoints;
}

/// With peers elsewhere, a machine's first process takes the router's port, so that they find it and, by it,
/// the others. When it goes, another one follows.
std::vector<std::string> listened(const ParticipantOptions& options) {
  if (options.loopback_only || options.peers.empty()) return {"tcp/127.0.0.1:0"};
  return {"tcp/0.0.0.0:0", fmt::format("tcp/0.0.0.0:{}", kRouterPort)};
}

}  // namespace

std::string zenoh_settings(const ParticipantOptions& options) {
  const bool elsewhere = !options.loopback_only && !options.peers.empty();
  return fmt::format(
      R"({{mode: "peer",
connect: {{timeout_ms: -1, exit_on_failure: false, endpoints: {}}},
listen: {{timeout_ms: {}, exit_on_failure: false, endpoints: {}}},
open: {{return_conditions: {{connect_scouted: true, declares: true}}}},
scouting: {{delay: {}, multicast: {{enabled: true, address: "224.0.0.224:{}", interface: "127.0.0.1"}}, gossip: {{enabled: true}}}},
timestamping: {{enabled: true}},
transport: {{
  link: {{
    tx: {{lease: {}, queue: {{size: {{data_low: {}}}, congestion_control: {{drop: {{wait_before_drop: {}}}, block: {{wait_before_close: {}}}}}}}}},
    rx: {{max_message_size: {}}},
  }},
  shared_memory: {{enabled: false}},
}}}})",
      nlohmann::json(connected(options)).dump(), elsewhere ? -1 : 0, nlohmann::json(listened(options)).dump(),
      kFindingMs, kScoutingPort + options.domain, kLeaseMs, kPictureBatches, kWaitBeforeDropUs,
      kWaitBeforeCloseUs, kLargestMessage);
}

}  // namespace rds::bus::detail
