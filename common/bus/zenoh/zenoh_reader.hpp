// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "common/bus/backend.hpp"
#include "common/bus/zenoh/wire/zenoh_attachment.hpp"
#include "common/bus/zenoh/zenoh_inbox.hpp"
#include "common/bus/zenoh/zenoh_node.hpp"
#include "common/bus/zenoh/zenoh_qos.hpp"

namespace rds::bus::detail {

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
  std::shared_ptr<ZenohInbox<ZenohSample>> inbox_;
  ZenohSubscriber subscriber_;
  AnnouncedEndpoint announced_;
  // Of the thread that takes:
  SequenceGaps gaps_;
  std::vector<std::uint8_t> gathered_;
  std::atomic<std::uint64_t> lost_ = 0;
};

}  // namespace rds::bus::detail
