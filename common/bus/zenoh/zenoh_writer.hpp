// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "common/bus/backend.hpp"
#include "common/bus/zenoh/wire/zenoh_attachment.hpp"
#include "common/bus/zenoh/zenoh_node.hpp"
#include "common/bus/zenoh/zenoh_qos.hpp"

namespace rds::bus::detail {

/// Encodes on the caller's thread and sends on one of its own, as Zenoh may wait for a reader: the newest
/// messages wait here, as many as the history holds, and what they displace is missing in the readers'
/// counts.
class ZenohWriter final : public BackendWriter {
 public:
  ZenohWriter(ZenohNode& node, const std::string& topic, const TypeOps& type, const Qos& qos);
  ~ZenohWriter() override;
  ZenohWriter(const ZenohWriter&) = delete;
  ZenohWriter& operator=(const ZenohWriter&) = delete;

  bool write(const void* message) override;
  [[nodiscard]] std::uint64_t lost() const override { return lost_; }
  [[nodiscard]] int matched() const override { return node_.graph().matched(topic_, type_.dds_name, true); }
  [[nodiscard]] Guid guid() const override { return gid_; }

 private:
  struct Waiting {
    ZenohBuffer buffer;
    ZenohAttachment attachment;
  };
  void send_all();

  ZenohNode& node_;
  std::string topic_;
  const TypeOps& type_;
  std::size_t depth_;
  bool keeps_;  // what was sent, for those who come later or have lost it
  std::string token_;
  Guid gid_;
  ZenohPublisher publisher_;
  AnnouncedEndpoint announced_;
  std::mutex mutex_;  // of the next four
  std::condition_variable changed_;
  std::deque<Waiting> waiting_;
  std::int64_t sequence_ = 0;
  bool closing_ = false;
  std::atomic<std::uint64_t> lost_ = 0;  // displaced while they waited, or refused by Zenoh
  std::thread sender_;                   // last: it uses the others
};

}  // namespace rds::bus::detail
