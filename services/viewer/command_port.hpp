// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "common/concurrency/mailbox.hpp"
#include "common/service/service.hpp"
#include "rds_msgs/msg/Command.h"
#include "rds_msgs/msg/CommandResult.h"
#include "services/viewer/core/board/page_client.hpp"

namespace rds::viewer {

/// Sends pages' commands to the services, and their answers to the page that asked.
class CommandPort {
 public:
  /// @param notify  called when an answer has come (bus threads).
  CommandPort(service::ServiceContext& context, std::function<void()> notify);

  void send(PageClient& page, const PageCommand& command);
  /// Hands answers to their pages.
  void take();
  /// The page goes: its answers are nobody's.
  void forget(const PageClient& page);

 private:
  using Result = std::shared_ptr<const rds_msgs::msg::CommandResult>;
  static constexpr std::size_t kMostAsked = 64;  // the oldest are forgotten

  struct Asked {
    PageClient* page = nullptr;
    std::string verb;
  };

  std::map<std::uint64_t, Asked> asked_;  // by request id, which count up
  std::uint64_t next_id_;
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<Result> results_;
  bus::Publisher<rds_msgs::msg::Command> commands_;
  bus::Subscription subscription_;  // last: its callback fills the inbox
};

}  // namespace rds::viewer
