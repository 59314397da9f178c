// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/zenoh_reader.hpp"

namespace rds::bus::detail {
namespace {

RdsZenohSubscriberOptions subscriber_options(const Qos& qos) {
  return {.history = qos.transient_local ? static_cast<std::size_t>(history_depth(qos)) : 0,
          .recover = recovers(qos)};
}

void push_sample(void* inbox, RdsZenohSample* sample) {
  (*static_cast<std::shared_ptr<ZenohInbox>*>(inbox))->push(ZenohSample(sample));
}

}  // namespace

void ZenohInbox::push(ZenohSample sample) {
  {
    const std::lock_guard lock(mutex_);
    samples_.push_back(std::move(sample));
    if (samples_.size() > depth_) samples_.pop_front();
  }
  changed_.notify_one();
}

ZenohSample ZenohInbox::pop() {
  const std::lock_guard lock(mutex_);
  if (samples_.empty()) return nullptr;
  ZenohSample sample = std::move(samples_.front());
  samples_.pop_front();
  return sample;
}

void ZenohInbox::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return woken_ || !samples_.empty(); });
}

bool ZenohInbox::wait_for(std::chrono::seconds limit) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, limit, [this] { return woken_ || !samples_.empty(); });
}

void ZenohInbox::wake() {
  {
    const std::lock_guard lock(mutex_);
    woken_ = true;
  }
  changed_.notify_one();
}

ZenohReader::ZenohReader(ZenohNode& node, const std::string& topic, const TypeOps& type, const Qos& qos)
    : node_(node),
      topic_(topic),
      type_(type),
      token_(node.new_endpoint(topic, type, qos, false)),
      gid_(gid_of_token(token_)),
      inbox_(std::make_shared<ZenohInbox>(static_cast<std::size_t>(history_depth(qos)))),
      subscriber_(declare_subscriber(node.session(), topic_key_of_any_version(node.domain(), topic, type),
                                     subscriber_options(qos), &push_sample, inbox_)),
      announced_(node, token_) {}

void ZenohReader::wait() {
  gathered_ = {};  // nothing has come for a while: no memory is kept
  inbox_->wait();
}

bool ZenohReader::take(Sample& sample) {
  const ZenohSample received = inbox_->pop();
  if (received == nullptr) return false;
  read(*received, sample);
  return true;
}

void ZenohReader::read(const RdsZenohSample& received, Sample& sample) {
  RdsZenohView view{};
  zenoh_library().view(&received, &view);
  if (view.attachment_size > kAttachmentSize) return;
  const auto attachment = parse_attachment({view.attachment, view.attachment_size});
  if (!attachment) return;
  lost_ += gaps_.count(*attachment);
  sample.writer = writer_of(attachment->gid, view);
  const std::string_view hash = type_hash_of_key({view.key, view.key_size});
  sample.another_version = !hash.empty() && !type_.type_hash.empty() && hash != type_.type_hash;
  if (sample.another_version) return;
  if (view.data == nullptr) {
    gathered_.resize(view.size);
    zenoh_library().gather(&received, gathered_.data());
    view.data = gathered_.data();
  }
  sample.decode(view.data, view.size);
}

/// Its token tells; where it is not known yet, the session that Zenoh names.
ParticipantId ZenohReader::writer_of(const Guid& gid, const RdsZenohView& view) const {
  if (const auto session = node_.graph().session_of(gid)) return participant_of(*session);
  return participant_of(session_guid(view.source).value_or(gid));
}

}  // namespace rds::bus::detail
