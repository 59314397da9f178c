// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/zenoh_settings.hpp"

#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/bus/zenoh/links/link_policy.hpp"
#include "common/bus/zenoh/zenoh_library.hpp"

namespace rds::bus::detail {
namespace {

using nlohmann::json;
using Endpoints = std::vector<std::string>;

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
/// What a process that shares memory takes of /dev/shm for its messages on their way [bytes].
constexpr int kSharedMemory = 16 << 20;
/// What the kernel may hold of a link to other machines [bytes]: that cannot be overtaken any more, and its
/// own choice, megabytes, takes a second on a link of 20 Mbit/s.
constexpr int kSendBuffer = 32 << 10;

/// A name or address without a port is that machine's router, or whoever listens in its place.
std::string endpoint_of(const std::string& peer, const ZenohAccess* access) {
  if (peer.find('/') == std::string::npos) {
    const std::string link = access == nullptr ? "tcp/" : "tls/";
    return link + peer + (peer.find(':') == std::string::npos ? fmt::format(":{}", kRouterPort) : "");
  }
  if (access != nullptr && !peer.starts_with("tls/"))
    throw BusError("peer '" + peer + "': expected tls/..., the domain is secured");
  return peer;
}

Endpoints endpoints_of(const Endpoints& peers, const ZenohAccess* access) {
  Endpoints endpoints;
  for (const std::string& peer : peers) endpoints.push_back(endpoint_of(peer, access));
  return endpoints;
}

Endpoints connected(const ParticipantOptions& options, const ZenohAccess* access) {
  if (options.loopback_only) return {};
  return endpoints_of(options.peers.empty() ? Endpoints{"127.0.0.1"} : options.peers, access);
}

/// With peers elsewhere, a machine's first process takes the router's port, so that they find it and, by it,
/// the others. When it goes, another one follows.
Endpoints listened(const ParticipantOptions& options, const ZenohAccess* access) {
  const std::string link = access == nullptr ? "tcp" : "tls";
  if (options.loopback_only || options.peers.empty()) return {link + "/127.0.0.1:0"};
  return {link + "/0.0.0.0:0", fmt::format("{}/0.0.0.0:{}", link, kRouterPort)};
}

json link_settings() {
  return {{"tx",
           {{"lease", kLeaseMs},
            {"queue",
             {{"size", {{"data_low", kPictureBatches}}},
              {"congestion_control",
               {{"drop", {{"wait_before_drop", kWaitBeforeDropUs}}},
                {"block", {{"wait_before_close", kWaitBeforeCloseUs}}}}}}}}},
          {"rx", {{"max_message_size", kLargestMessage}}}};
}

/// Off unless the user's settings say `enabled`: a process that is killed leaves its memory until another one
/// begins.
json shared_memory_settings() {
  return {{"enabled", false},
          {"transport_optimization",
           {{"pool_size", kSharedMemory}, {"message_size_threshold", kLeastShared}, {"messages", {"put"}}}}};
}

/// What a router and a participant have in common.
/// @param elsewhere  whether there are links to other machines.
json common_settings(const ZenohAccess* access, bool elsewhere) {
  json settings{{"timestamping", {{"enabled", true}}},
                {"transport", {{"link", link_settings()}, {"shared_memory", shared_memory_settings()}}}};
  if (elsewhere)
    for (const char* kind : {"tcp", "tls"}) settings["transport"]["link"][kind]["so_sndbuf"] = kSendBuffer;
  if (access == nullptr) return settings;
  // Both sides show a certificate of the domain's authority, and are known by the name in it: where they are
  // found says nothing.
  const Credentials& own = access->credentials();
  settings["transport"]["link"]["protocols"] = {"tls"};
  settings["transport"]["link"]["tls"].update({{"root_ca_certificate", own.ca.string()},
                                               {"enable_mtls", true},
                                               {"listen_certificate", own.certificate.string()},
                                               {"listen_private_key", own.key.string()},
                                               {"connect_certificate", own.certificate.string()},
                                               {"connect_private_key", own.key.string()},
                                               {"verify_name_on_connect", false},
                                               {"close_link_on_expiration", true}});
  settings["access_control"] = access->rules();
  return settings;
}

json connections(const Endpoints& endpoints, int timeout_ms) {
  return {{"timeout_ms", timeout_ms}, {"exit_on_failure", false}, {"endpoints", endpoints}};
}

}  // namespace

std::string unnamed_endpoint(const ParticipantOptions& options, const ZenohAccess* access) {
  const Endpoints endpoints = options.peers.empty() ? connected(options, access) : Endpoints{};
  if (endpoints.empty()) return "";
  std::ifstream file(users_settings() == nullptr ? "" : users_settings());
  const std::string users{std::istreambuf_iterator<char>(file), {}};
  return users.find(endpoints.front()) == std::string::npos ? endpoints.front() : "";
}

std::string zenoh_settings(const ParticipantOptions& options, const ZenohAccess* access) {
  const bool elsewhere = !options.loopback_only && !options.peers.empty();
  const int reach_within = static_cast<int>(link_policy().reach_within.count());
  json settings = common_settings(access, elsewhere);
  settings["mode"] = "peer";
  settings["connect"] = connections(connected(options, access), reach_within > 0 ? reach_within : -1);
  settings["listen"] = connections(listened(options, access), elsewhere ? -1 : 0);
  settings["open"] = {{"return_conditions", {{"connect_scouted", true}, {"declares", true}}}};
  settings["scouting"] = {{"delay", kFindingMs},
                          {"multicast",
                           {{"enabled", true},
                            {"address", fmt::format("224.0.0.224:{}", kScoutingPort + options.domain)},
                            {"interface", "127.0.0.1"}}},
                          {"gossip", {{"enabled", true}}}};
  return settings.dump();
}

std::string zenoh_router_settings(const Endpoints& listen, const Endpoints& connect,
                                  const ZenohAccess* access) {
  json settings = common_settings(access, true);
  settings["mode"] = "router";
  settings["listen"] = {
      {"timeout_ms", 0}, {"exit_on_failure", true}, {"endpoints", endpoints_of(listen, access)}};
  settings["connect"] = connections(endpoints_of(connect, access), -1);
  settings["scouting"] = {{"multicast", {{"enabled", false}}}, {"gossip", {{"enabled", true}}}};
  return settings.dump();
}

}  // namespace rds::bus::detail
