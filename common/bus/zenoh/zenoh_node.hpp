// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "common/bus/zenoh/zenoh_access.hpp"
#include "common/bus/zenoh/zenoh_graph.hpp"
#include "common/bus/zenoh/zenoh_library.hpp"

namespace rds::bus::detail {

/// A session of Zenoh that says by its tokens which node of ROS 2 it is, and hears those of the others.
class ZenohNode {
 public:
  /// @param access  of a secured domain, or null. @throws BusError
  ZenohNode(const ParticipantOptions& options, const ZenohAccess* access);

  [[nodiscard]] const ZenohSession& session() const { return session_; }
  [[nodiscard]] const ZenohGraph& graph() const { return *graph_; }
  [[nodiscard]] int domain() const { return name_.domain; }
  [[nodiscard]] const Guid& guid() const { return guid_; }

  /// The token of an endpoint that is new.
  std::string new_endpoint(const std::string& topic, const TypeOps& type, const Qos& qos, bool publisher);
  std::string new_service(const std::string& name, const ServiceType& type) {
    return service_token(name_, ++entities_, name, type, true);
  }
  void add_own(const std::string& token) { graph_->add_own(token); }
  void remove_own(const std::string& token) { graph_->remove_own(token); }

 private:
  ZenohSession session_;
  ZenohNodeName name_;
  Guid guid_;
  std::shared_ptr<ZenohGraph> graph_;
  std::atomic<int> entities_ = 0;
  ZenohToken token_;
  ZenohWatch watch_;
};

/// While it lives the others know of an endpoint.
class AnnouncedEndpoint {
 public:
  AnnouncedEndpoint(ZenohNode& node, const std::string& token)
      : node_(node), text_(token), token_(declare_token(node.session(), token)) {
    node_.add_own(text_);
  }
  ~AnnouncedEndpoint() { node_.remove_own(text_); }
  AnnouncedEndpoint(const AnnouncedEndpoint&) = delete;
  AnnouncedEndpoint& operator=(const AnnouncedEndpoint&) = delete;

 private:
  ZenohNode& node_;
  std::string text_;
  ZenohToken token_;
};

}  // namespace rds::bus::detail
