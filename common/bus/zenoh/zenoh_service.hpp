// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "common/bus/backend.hpp"
#include "common/bus/zenoh/wire/zenoh_attachment.hpp"
#include "common/bus/zenoh/zenoh_inbox.hpp"
#include "common/bus/zenoh/zenoh_node.hpp"

namespace rds::bus::detail {

/// Sends the answers of all services on a thread of its own: where the link to who has asked is full, Zenoh
/// waits.
class ZenohReplies {
 public:
  ZenohReplies() : sender_([this](const std::stop_token& stop) { send_all(stop); }) {}

  void push(ZenohQuery query, ZenohBuffer response, const ZenohAttachment& attachment);

 private:
  /// Answers that wait for one who does not read; further ones push out the oldest.
  static constexpr std::size_t kMostWaiting = 64;
  struct Waiting {
    ZenohQuery query;
    ZenohBuffer response;
    ZenohAttachment attachment;
  };
  void send_all(const std::stop_token& stop);

  std::mutex mutex_;  // of the next two
  std::condition_variable_any changed_;
  std::deque<Waiting> waiting_;
  std::jthread sender_;  // last: it uses the others
};

/// A service in the form of rmw_zenoh: a queryable that is complete. Requests and answers carry the
/// attachment of messages; that of an answer names the request.
class ZenohService final : public BackendService {
 public:
  ZenohService(ZenohNode& node, std::shared_ptr<ZenohReplies> replies, const std::string& name,
               const ServiceType& type);

  void wait() override { inbox_->wait(); }
  void wake() override { inbox_->wake(); }
  bool take(Sample& sample, Caller& caller) override;
  bool reply(const Caller& caller, const void* response) override;
  [[nodiscard]] std::uint64_t lost() const override { return inbox_->displaced(); }
  // ROS knows a service by one gid.
  [[nodiscard]] Guid request_reader() const override { return gid_; }
  [[nodiscard]] Guid reply_writer() const override { return gid_; }

 private:
  /// Requests that may be unanswered; of further ones the oldest is given up.
  static constexpr std::size_t kMostOpen = 256;
  struct Open {
    Guid client{};
    std::int64_t request = 0;
    ZenohQuery query;
  };
  void keep(const Caller& caller, ZenohQuery query);
  ZenohQuery take_open(const Caller& caller);

  ZenohNode& node_;
  std::shared_ptr<ZenohReplies> replies_;
  const TypeOps& response_;
  std::string token_;
  Guid gid_;
  std::shared_ptr<ZenohInbox<ZenohQuery>> inbox_;
  ZenohQueryable queryable_;
  AnnouncedEndpoint announced_;
  std::mutex mutex_;
  std::deque<Open> open_;
};

}  // namespace rds::bus::detail
