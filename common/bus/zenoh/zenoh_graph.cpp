// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/zenoh_graph.hpp"

namespace rds::bus::detail {

void ZenohGraph::take(std::string_view token, bool alive) {
  const Guid gid = gid_of_token(token);
  if (is_client_token(token)) {
    if (!alive) {
      clients_.remove(gid);
    } else if (clients_.size() < kMostEndpoints) {
      // as a publisher: those are remembered when they leave
      clients_.put(gid, {.topic = "", .type = "", .publisher = true, .guid = text_of(gid)}, gid);
    }
    return;
  }
  auto read = parse_endpoint_token(token);
  if (!read || read->session == session_) return;
  if (!alive) {
    others_.remove(gid);
  } else if (others_.size() < kMostEndpoints) {
    others_.put(gid, std::move(read->endpoint), read->session);
  }
}

bool ZenohGraph::has_left(const Guid& client) const {
  const auto is_he = [guid = text_of(client)](const DiscoveredEndpoint& other) { return other.guid == guid; };
  return clients_.guid_of(client) && clients_.count_if(is_he) == 0;
}

void ZenohGraph::add_own(std::string_view token) {
  if (auto read = parse_endpoint_token(token))
    own_.put(gid_of_token(token), std::move(read->endpoint), read->session);
}

int ZenohGraph::matched(const std::string& topic, const std::string& type, bool publisher) const {
  const auto is_other_side = [&](const DiscoveredEndpoint& other) {
    return other.publisher != publisher && other.topic == topic && other.type == type;
  };
  return own_.count_if(is_other_side) + others_.count_if(is_other_side);
}

std::optional<Guid> ZenohGraph::session_of(const Guid& gid) const {
  const auto other = others_.guid_of(gid);
  return other ? other : own_.guid_of(gid);
}

}  // namespace rds::bus::detail
