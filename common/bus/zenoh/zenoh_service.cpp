// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/zenoh_service.hpp"

#include <algorithm>

namespace rds::bus::detail {
namespace {

using std::chrono::system_clock;

/// Requests that wait (rmw_qos_profile_services_default).
constexpr std::size_t kRequests = 10;

void push_query(void* inbox, RdsZenohQuery* query) {
  RdsZenohView view{};
  zenoh_library().view_query(query, &view);
  (*static_cast<std::shared_ptr<ZenohInbox<ZenohQuery>>*>(inbox))
      ->push(ZenohQuery(query), view.size + view.attachment_size);
}

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(system_clock::now().time_since_epoch()).count();
}

}  // namespace

void ZenohReplies::push(ZenohQuery query, ZenohBuffer response, const ZenohAttachment& attachment) {
  Waiting displaced;  // ends without the lock
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back({std::move(query), std::move(response), attachment});
    if (waiting_.size() > kMostWaiting) {
      displaced = std::move(waiting_.front());
      waiting_.pop_front();
    }
  }
  changed_.notify_one();
}

void ZenohReplies::send_all(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return !waiting_.empty(); })) {
    Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    const auto attachment = to_bytes(next.attachment);
    zenoh_library().reply(next.query.get(), next.response.release(), attachment.data(), attachment.size());
    next.query.reset();  // which tells who has asked that there is no other answer
    lock.lock();
  }
}

ZenohService::ZenohService(ZenohNode& node, std::shared_ptr<ZenohReplies> replies, const std::string& name,
                           const ServiceType& type)
    : node_(node),
      replies_(std::move(replies)),
      response_(type.response),
      token_(node.new_service(name, type)),
      gid_(gid_of_token(token_)),
      inbox_(std::make_shared<ZenohInbox<ZenohQuery>>(kRequests)),
      queryable_(
          declare_queryable(node.session(), service_key(node.domain(), name, type), &push_query, inbox_)),
      announced_(node, token_) {}

bool ZenohService::take(Sample& sample, Caller& caller) {
  ZenohQuery query = inbox_->pop();
  if (query == nullptr) return false;
  RdsZenohView view{};
  zenoh_library().view_query(query.get(), &view);
  if (view.attachment_size > kAttachmentSize) return true;
  const auto attachment = parse_attachment({view.attachment, view.attachment_size});
  if (!attachment) return true;
  std::vector<std::uint8_t> gathered;
  if (view.data == nullptr) {
    gathered.resize(view.size);
    zenoh_library().gather_query(query.get(), gathered.data());
    view.data = gathered.data();
  }
  sample.decode(view.data, view.size);
  caller = {attachment->gid, attachment->sequence, participant_of(attachment->gid)};
  if (sample.decoded) keep(caller, std::move(query));
  return true;
}

void ZenohService::keep(const Caller& caller, ZenohQuery query) {
  const std::lock_guard lock(mutex_);
  open_.push_back({caller.client, caller.request, std::move(query)});
  if (open_.size() > kMostOpen) open_.pop_front();
}

ZenohQuery ZenohService::take_open(const Caller& caller) {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find_if(open_, [&](const Open& open) {
    return open.client == caller.client && open.request == caller.request;
  });
  if (found == open_.end()) return nullptr;
  ZenohQuery query = std::move(found->query);
  open_.erase(found);
  return query;
}

bool ZenohService::reply(const Caller& caller, const void* response) {
  ZenohQuery query = take_open(caller);
  if (query == nullptr || node_.graph().has_left(caller.client)) return false;
  const std::size_t size = response_.encoded_size(response);
  std::uint8_t* bytes = nullptr;
  ZenohBuffer buffer(zenoh_library().make_buffer(node_.session().get(), size, false, &bytes));
  if (buffer == nullptr || response_.encode(response, bytes, size) == 0) return false;
  replies_->push(std::move(query), std::move(buffer), {caller.request, now_ns(), caller.client});
  return true;
}

}  // namespace rds::bus::detail
