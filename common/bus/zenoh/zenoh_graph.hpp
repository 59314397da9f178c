// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "common/bus/endpoint_directory.hpp"
#include "common/bus/zenoh/wire/zenoh_names.hpp"

namespace rds::bus::detail {

/// Who is on the bus, by the tokens that are alive: the endpoints of a domain by their gid. Thread-safe.
class ZenohGraph {
 public:
  /// @param session  our own: its tokens come as add_own(), not from the network.
  explicit ZenohGraph(const Guid& session) : session_(session) {}

  /// From the network. What is no endpoint's token of somebody else is left out.
  void take(std::string_view token, bool alive);

  void add_own(std::string_view token);
  void remove_own(std::string_view token) { own_.remove(gid_of_token(token)); }

  /// Of all other sessions.
  [[nodiscard]] std::vector<DiscoveredEndpoint> discovered() const { return others_.endpoints(); }
  /// Endpoints, our own too, at the other side of this one.
  [[nodiscard]] int matched(const std::string& topic, const std::string& type, bool publisher) const;
  /// Whether this client of a service was there and is no more.
  [[nodiscard]] bool has_left(const Guid& client) const;
  /// The session that a writer is of; nullopt for one that was never announced.
  [[nodiscard]] std::optional<Guid> session_of(const Guid& gid) const;

 private:
  static constexpr std::size_t kMostEndpoints = 10'000;  // a stranger may make up any number of them

  Guid session_;
  EndpointDirectory<Guid> own_;
  EndpointDirectory<Guid> others_;
  EndpointDirectory<Guid> clients_;  // of services
};

}  // namespace rds::bus::detail
