// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/zenoh_reader.hpp"

namespace rds::bus::detail {
namespace {

RdsZenohSubscriberOptions subscriber_options(const Qos& qos) {
  return {.history = qos.transient_local ? static_cast<std::size_t>(history_depth(qos)) : 0,
          .recover = recovers(qos)};
}

void push_sample(void* inbox, RdsZenohSample* sample) {
  RdsZenohView view{};
  zenoh_library().view(sample, &view);
  (*static_cast<std::shared_ptr<ZenohInbox<ZenohSample>>*>(inbox))
      ->push(ZenohSample(sample), view.size + view.attachment_size);
}

}  // namespace

ZenohReader::ZenohReader(ZenohNode& node, const std::string& topic, const TypeOps& type, const Qos& qos)
    : node_(node),
      topic_(topic),
      type_(type),
      token_(node.new_endpoint(topic, type, qos, false)),
      gid_(gid_of_token(token_)),
      inbox_(std::make_shared<ZenohInbox<ZenohSample>>(static_cast<std::size_t>(history_depth(qos)))),
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
  sample.decoded = sample.decoded && zenoh_library().intact(&received) != 0;
}

/// Its token tells; where it is not known yet, the session that Zenoh names.
ParticipantId ZenohReader::writer_of(const Guid& gid, const RdsZenohView& view) const {
  if (const auto session = node_.graph().session_of(gid)) return participant_of(*session);
  return participant_of(session_guid(view.source).value_or(gid));
}

}  // namespace rds::bus::detail
