// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/zenoh_node.hpp"

#include <array>

#include "common/bus/zenoh/links/link_policy.hpp"
#include "common/bus/zenoh/zenoh_settings.hpp"

namespace rds::bus::detail {
namespace {

std::string id_of(const ZenohSession& session) {
  std::array<char, 33> text{};
  zenoh_library().id(session.get(), text.data());
  return text.data();
}

ZenohSession open_node(const ParticipantOptions& options, const ZenohAccess* access) {
  ignore_endpoint(unnamed_endpoint(options, access));
  return open_zenoh(zenoh_settings(options, access), users_settings());
}

void take_token(void* graph, const char* token, std::size_t size, int alive) {
  (*static_cast<std::shared_ptr<ZenohGraph>*>(graph))->take({token, size}, alive != 0);
}

}  // namespace

ZenohNode::ZenohNode(const ParticipantOptions& options, const ZenohAccess* access)
    : session_(open_node(options, access)),
      name_{options.domain, id_of(session_), options.node_name, normal_namespace(options.node_namespace)},
      guid_(session_guid(name_.session).value_or(Guid{})),
      graph_(std::make_shared<ZenohGraph>(guid_)),
      token_(declare_token(session_, node_token(name_))),
      watch_(declare_watch(session_, all_tokens(options.domain), &take_token, graph_)) {}

std::string ZenohNode::new_endpoint(const std::string& topic, const TypeOps& type, const Qos& qos,
                                    bool publisher) {
  return endpoint_token(name_, ++entities_, topic, type, qos, publisher);
}

}  // namespace rds::bus::detail
