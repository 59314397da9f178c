// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/zenoh_writer.hpp"

#include <algorithm>

#include <pthread.h>
#include <sched.h>

#include "common/bus/zenoh/zenoh_settings.hpp"

namespace rds::bus::detail {
namespace {

using std::chrono::steady_clock;
using std::chrono::system_clock;

/// Messages that wait to be sent at least, whatever the history: two in a row are no reason to lose the
/// first.
constexpr int kShortestQueue = 8;
/// Of datagrams: as many as a reader asks for at most.
constexpr int kDatagramQueue = 4096;
/// How long a writer that goes still sends what waits.
constexpr std::chrono::seconds kFarewell{1};
/// As rmw_zenoh's.
constexpr std::uint64_t kHeartbeatMs = 500;

/// Zenoh's classes, from 1 (real time) to 7 (background).
std::uint8_t priority_of(Urgency urgency) {
  constexpr std::uint8_t kInteractiveHigh = 2;
  return static_cast<std::uint8_t>(kInteractiveHigh + static_cast<int>(urgency));
}

bool are_datagrams(const Qos& qos) {
  return !qos.reliable && qos.urgency != Urgency::kPictures;
}

std::size_t queue_depth(const Qos& qos) {
  return static_cast<std::size_t>(
      std::max(history_depth(qos), are_datagrams(qos) ? kDatagramQueue : kShortestQueue));
}

bool keeps(const Qos& qos) {
  return qos.transient_local || recovers(qos);
}

RdsZenohPublisherOptions publisher_options(const Qos& qos) {
  return {.priority = priority_of(qos.urgency),
          .express = qos.urgency <= Urgency::kBoxes,
          .reliable = qos.reliable,
          .droppable = are_datagrams(qos),
          .latched = qos.transient_local,
          .cache = keeps(qos) ? static_cast<std::size_t>(history_depth(qos)) : 0,
          .heartbeat_ms = recovers(qos) ? kHeartbeatMs : 0};
}

/// Of the calling thread: else the kernel lets it send at once in the place of the thread that wrote, which
/// then waits for a core again, as long as a busy machine takes. It still wakes up on another core if one is
/// idle.
void never_preempt_who_wakes() {
  const sched_param none{};
  pthread_setschedparam(pthread_self(), SCHED_BATCH, &none);
}

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(system_clock::now().time_since_epoch()).count();
}

}  // namespace

ZenohWriter::ZenohWriter(ZenohNode& node, const std::string& topic, const TypeOps& type, const Qos& qos)
    : node_(node),
      topic_(topic),
      type_(type),
      depth_(queue_depth(qos)),
      keeps_(keeps(qos)),
      token_(node.new_endpoint(topic, type, qos, true)),
      gid_(gid_of_token(token_)),
      publisher_(
          declare_publisher(node.session(), topic_key(node.domain(), topic, type), publisher_options(qos))),
      announced_(node, token_),
      sender_([this] { send_all(); }) {}

ZenohWriter::~ZenohWriter() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  changed_.notify_one();
  sender_.join();
}

bool ZenohWriter::write(const void* message) {
  const std::size_t size = type_.encoded_size(message);
  std::uint8_t* bytes = nullptr;
  const bool share = !keeps_ && size >= kLeastShared;
  ZenohBuffer buffer(zenoh_library().make_buffer(node_.session().get(), size, share, &bytes));
  if (buffer == nullptr || type_.encode(message, bytes, size) == 0) return false;
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back({std::move(buffer), {++sequence_, now_ns(), gid_}});
    if (waiting_.size() > depth_) {
      waiting_.pop_front();
      ++lost_;
    }
  }
  changed_.notify_one();
  return true;
}

void ZenohWriter::send_all() {
  never_preempt_who_wakes();
  steady_clock::time_point end = steady_clock::time_point::max();
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return closing_ || !waiting_.empty(); });
    if (closing_ && end == steady_clock::time_point::max()) end = steady_clock::now() + kFarewell;
    if (waiting_.empty() || steady_clock::now() > end) return;
    Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    const auto attachment = to_bytes(next.attachment);
    if (!zenoh_library().put(publisher_.get(), next.buffer.release(), attachment.data(), attachment.size()))
      ++lost_;
    lock.lock();
  }
}

}  // namespace rds::bus::detail
