// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/bus/guid.hpp"
#include "common/bus/participant.hpp"
#include "common/bus/service_type.hpp"

/// What rmw_zenoh calls things on the network (its docs/design.md; Jazzy 0.2.4 and later, Kilted 0.6 and
/// later).
namespace rds::bus::detail {

/// A session's identifier, as 16 bytes; the text is hexadecimal, without leading zeros.
/// @return nullopt for what is none.
std::optional<Guid> session_guid(std::string_view text);

/// Where the messages of a topic go: "0/rds/odometry/nav_msgs::msg::dds_::Odometry_/RIHS01_…".
/// @throws BusError for a topic's name that is none.
std::string topic_key(int domain, const std::string& topic, const TypeOps& type);

/// As topic_key(), for the messages of all definitions of the type.
std::string topic_key_of_any_version(int domain, const std::string& topic, const TypeOps& type);

/// Where the requests of a service go: "0/node/reset/std_srvs::srv::dds_::Trigger_/RIHS01_…".
/// @throws BusError for a name that is none.
std::string service_key(int domain, const std::string& name, const ServiceType& type);

/// The type hash at the end of a topic's key; "" where it has none.
std::string_view type_hash_of_key(std::string_view key);

/// Whose tokens these are.
struct ZenohNodeName {
  int domain = 0;
  std::string session;  // identifier
  std::string name;
  std::string node_namespace = "/";
};

/// All tokens of a domain.
std::string all_tokens(int domain);
std::string node_token(const ZenohNodeName& node);
/// @param entity  number of the endpoint in its session, from 1.
std::string endpoint_token(const ZenohNodeName& node, int entity, const std::string& topic,
                           const TypeOps& type, const Qos& qos, bool publisher);

/// Of a service's server or client.
std::string service_token(const ZenohNodeName& node, int entity, const std::string& name,
                          const ServiceType& type, bool server);

/// By which messages name their writer: XXH3 (128 bits) of its token.
Guid gid_of_token(std::string_view token);

struct ZenohEndpoint {
  Guid session{};
  DiscoveredEndpoint endpoint;  // with the gid as guid
};

/// @return nullopt for everything but a well-formed token of a publisher or subscription.
std::optional<ZenohEndpoint> parse_endpoint_token(std::string_view token);

/// @return whether this is the token of a service's client.
bool is_client_token(std::string_view token);

}  // namespace rds::bus::detail
