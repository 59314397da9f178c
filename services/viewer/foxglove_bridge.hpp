// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/concurrency/mailbox.hpp"
#include "common/messages/serialized.hpp"
#include "common/service/service.hpp"
#include "services/viewer/core/foxglove/foxglove_client.hpp"
#include "services/viewer/viewer_service_config.hpp"

namespace rds::viewer {

/// The bus for clients of Foxglove's protocol: our topics of standard types, and some of ours, as they are on
/// the wire. It joins the bus as a participant of its own while there is such a client, and reads a topic
/// while one hears it.
class FoxgloveBridge {
 public:
  /// @param notify  called when a message has come (bus threads).
  FoxgloveBridge(service::ServiceContext& context, const ViewerServiceConfig& config,
                 std::function<void()> notify);
  ~FoxgloveBridge() { stop_listening(); }
  FoxgloveBridge(const FoxgloveBridge&) = delete;
  FoxgloveBridge& operator=(const FoxgloveBridge&) = delete;

  std::unique_ptr<foxglove::FoxgloveClient> open();
  /// The client goes.
  void close(const foxglove::FoxgloveClient& client);
  /// Hands what has come to those who hear it.
  void take();
  /// No callback runs after this.
  void stop_listening();

 private:
  struct Topic {
    std::string name;  // without a leading slash
    bus::Qos qos;
    bus::TypeOps type;  // carried as bytes
    std::unique_ptr<bus::detail::SubscriptionEndpoint> subscription;
    std::optional<foxglove::Sample> latched;  // of a transient-local topic the newest
  };

  template <class Message>
  void offer(const std::string& name, const bus::Qos& qos);
  void hear(foxglove::FoxgloveClient& client, std::uint32_t channel);
  void leave_unheard();

  service::ServiceContext& context_;
  std::function<void()> notify_;
  std::vector<foxglove::Channel> channels_;
  std::map<std::uint32_t, Topic> topics_;  // by channel; its types outlive the participant
  std::set<foxglove::FoxgloveClient*> clients_;
  std::string session_;
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<foxglove::Sample> samples_;
  std::unique_ptr<bus::Participant> bus_;
};

}  // namespace rds::viewer
