// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/wire/zenoh_names.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "common/bus/backend.hpp"
#include "common/bus/type_version.hpp"

namespace rds::bus::detail {
namespace {

constexpr const char* kNoHash = "TypeHashNotSupported";
constexpr std::size_t kLongestToken = 2048;  // bytes; ROS allows names of 255
constexpr std::size_t kLongestId = 32;       // digits

int value_of_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

/// "/" becomes "%": a name is one chunk of a token.
std::string mangled(std::string name) {
  std::ranges::replace(name, '/', '%');
  return name;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t end = text.find(separator); end != std::string_view::npos; end = text.find(separator)) {
    parts.push_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  parts.push_back(text);
  return parts;
}

std::string hash_in_names(const TypeOps& type) {
  return type.type_hash.empty() ? kNoHash : type.type_hash;
}

std::string key(int domain, const std::string& name, const std::string& type, const std::string& hash) {
  if (name.empty() || name.find_first_of("*$?#@") != std::string::npos)
    throw BusError("topic '" + name + "': expected a name without * $ ? # @");
  return fmt::format("{}/{}/{}/{}", domain, name, type, hash);
}

/// "std_srvs::srv::dds_::Trigger_" of "std_srvs::srv::dds_::Trigger_Request_".
std::string service_name_of(const ServiceType& type) {
  const std::string& request = type.request.dds_name;
  return request.substr(0, request.rfind("Request_"));
}

std::string node_prefix(const ZenohNodeName& node, int entity, const char* kind) {
  return fmt::format("@ros2_lv/{}/{}/0/{}/{}/%/{}/{}", node.domain, node.session, entity, kind,
                     mangled(node.node_namespace), mangled(node.name));
}

/// What equals rmw_zenoh's defaults is left out: reliable 1, volatile 2, keep last 1, a depth of 42, no
/// limits.
std::string qos_text(const Qos& qos) {
  const int depth = history_depth(qos);
  return fmt::format("{}:{}:,{}:,:,:,,", qos.reliable ? "" : "2", qos.transient_local ? "1" : "",
                     depth == 42 ? "" : std::to_string(depth));
}

/// @return false for what is no QoS.
bool read_qos(std::string_view text, DiscoveredEndpoint& endpoint) {
  constexpr std::size_t kFields = 6;
  const auto fields = split(text, ':');
  const auto is_number = [](std::string_view field) {
    return field.size() <= 1 && std::ranges::all_of(field, [](char c) { return c >= '0' && c <= '9'; });
  };
  if (fields.size() != kFields || !is_number(fields[0]) || !is_number(fields[1])) return false;
  endpoint.reliable = fields[0] != "2";
  endpoint.transient_local = fields[1] == "1";
  return true;
}

}  // namespace

std::optional<Guid> session_guid(std::string_view text) {
  if (text.empty() || text.size() > kLongestId) return std::nullopt;
  Guid guid{};
  std::size_t digit = kLongestId - text.size();
  for (const char c : text) {
    const int value = value_of_digit(c);
    if (value < 0) return std::nullopt;
    guid[digit / 2] = static_cast<std::uint8_t>(guid[digit / 2] << 4U | static_cast<unsigned>(value));
    ++digit;
  }
  return guid;
}

std::string topic_key(int domain, const std::string& topic, const TypeOps& type) {
  return key(domain, topic, type.dds_name, hash_in_names(type));
}

std::string topic_key_of_any_version(int domain, const std::string& topic, const TypeOps& type) {
  return key(domain, topic, type.dds_name, "*");
}

std::string service_key(int domain, const std::string& name, const ServiceType& type) {
  return key(domain, name, service_name_of(type), type.type_hash);
}

std::string_view type_hash_of_key(std::string_view key) {
  const std::string_view last = key.substr(key.rfind('/') + 1);
  return is_type_hash(last) ? last : std::string_view();
}

std::string all_tokens(int domain) {
  return fmt::format("@ros2_lv/{}/**", domain);
}

std::string node_token(const ZenohNodeName& node) {
  return node_prefix(node, 0, "NN");
}

std::string endpoint_token(const ZenohNodeName& node, int entity, const std::string& topic,
                           const TypeOps& type, const Qos& qos, bool publisher) {
  return fmt::format("{}/{}/{}/{}/{}", node_prefix(node, entity, publisher ? "MP" : "MS"),
                     mangled("/" + topic), type.dds_name, hash_in_names(type), qos_text(qos));
}

std::string service_token(const ZenohNodeName& node, int entity, const std::string& name,
                          const ServiceType& type, bool server) {
  return fmt::format("{}/{}/{}/{}/{}", node_prefix(node, entity, server ? "SS" : "SC"), mangled("/" + name),
                     service_name_of(type), type.type_hash, qos_text({.reliable = true, .depth = 10}));
}

bool is_client_token(std::string_view token) {
  constexpr std::size_t kKind = 5;
  const auto chunks = split(token.substr(0, kLongestToken), '/');
  return chunks.size() > kKind && chunks[0] == "@ros2_lv" && chunks[kKind] == "SC";
}

Guid gid_of_token(std::string_view token) {
  const XXH128_hash_t hash = XXH3_128bits(token.data(), token.size());
  Guid gid{};
  for (std::size_t i = 0; i < 8; ++i) {
    gid[i] = static_cast<std::uint8_t>(hash.low64 >> (8 * i));
    gid[8 + i] = static_cast<std::uint8_t>(hash.high64 >> (8 * i));
  }
  return gid;
}

std::optional<ZenohEndpoint> parse_endpoint_token(std::string_view token) {
  // @ros2_lv, domain, session, node, entity, kind, enclave, namespace, node's name, topic, type, hash, QoS
  constexpr std::size_t kChunks = 13;
  if (token.size() > kLongestToken) return std::nullopt;
  const auto chunks = split(token, '/');
  if (chunks.size() != kChunks || chunks[0] != "@ros2_lv") return std::nullopt;
  const std::string_view kind = chunks[5];
  const auto session = session_guid(chunks[2]);
  if (!session || (kind != "MP" && kind != "MS")) return std::nullopt;
  if (chunks[9].size() < 2 || chunks[9].front() != '%' || chunks[10].empty()) return std::nullopt;
  ZenohEndpoint result{*session, {}};
  result.endpoint.topic = chunks[9].substr(1);
  std::ranges::replace(result.endpoint.topic, '%', '/');
  result.endpoint.type = chunks[10];
  result.endpoint.publisher = kind == "MP";
  if (is_type_hash(chunks[11])) result.endpoint.type_hash = chunks[11];
  result.endpoint.guid = text_of(gid_of_token(token));
  if (!read_qos(chunks[12], result.endpoint)) return std::nullopt;
  return result;
}

}  // namespace rds::bus::detail
