// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>

#include "common/bus/backend.hpp"
#include "common/bus/zenoh/zenoh_attachment.hpp"
#include "common/bus/zenoh/zenoh_node.hpp"
#include "common/bus/zenoh/zenoh_qos.hpp"

namespace rds::bus::detail {

/// The newest samples that have come and were not taken yet. Thread-safe.
class ZenohInbox {
 public:
  explicit ZenohInbox(std::size_t depth) : depth_(depth) {}

  void push(ZenohSample sample);
  /// @return null if there is none.
  ZenohSample pop();
  void wait();
  /// @return false if nothing has come meanwhile.
  bool wait_for(std::chrono::seconds limit);
  void wake();

 private:
  std::size_t depth_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<ZenohSample> samples_;
  bool woken_ = false;
};

class ZenohReader final : public BackendReader {
 public:
  ZenohReader(ZenohNode& node, const std::string& topic, const TypeOps& type, const Qos& qos);

  void wait() override;
  bool wait_for(std::chrono::seconds limit) override { return inbox_->wait_for(limit); }
  void wake() override { inbox_->wake(); }
  bool take(Sample& sample) override;
  [[nodiscard]] std::uint64_t lost() const override { return lost_; }
  [[nodiscard]] int matched() const override { return node_.graph().matched(topic_, type_.dds_name, false); }
  [[nodiscard]] Guid guid() const override { return gid_; }

 private:
  void read(const RdsZenohSample& received, Sample& sample);
  [[nodiscard]] ParticipantId writer_of(const Guid& gid, const RdsZenohView& view) const;

  ZenohNode& node_;
  std::string topic_;
  const TypeOps& type_;
  std::string token_;
  Guid gid_;
  std::shared_ptr<ZenohInbox> inbox_;
  ZenohSubscriber subscriber_;
  AnnouncedEndpoint announced_;
  // Of the thread that takes:
  SequenceGaps gaps_;
  std::vector<std::uint8_t> gathered_;
  std::atomic<std::uint64_t> lost_ = 0;
};

}  // namespace rds::bus::detail
