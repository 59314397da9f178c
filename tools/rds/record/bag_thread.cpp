// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/record/bag_thread.hpp"

#include <limits>

#include "common/concurrency/priority.hpp"

namespace rds::record {
namespace {

constexpr std::chrono::milliseconds kFlushPeriod{500};
constexpr std::size_t kNotYet = std::numeric_limits<std::size_t>::max();

}  // namespace

BagThread::BagThread(std::unique_ptr<recording::BagWriter> bag, std::size_t queue_bytes)
    : bag_(std::move(bag)),
      queue_(queue_bytes),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

std::size_t BagThread::add_topic(recording::BagTopic topic) {
  const std::lock_guard lock(mutex_);
  counts_.push_back({std::move(topic)});
  return counts_.size() - 1;
}

void BagThread::push(Received received) {
  const std::size_t topic = received.topic;
  if (queue_.push(std::move(received))) return;
  const std::lock_guard lock(mutex_);
  ++counts_[topic].dropped;
}

std::vector<BagThread::Count> BagThread::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

void BagThread::run(const std::stop_token& stop) {
  concurrency::give_way(kNice);
  auto flushed = std::chrono::steady_clock::now();
  bool stopping = false;
  while (result_ && !stopping) {
    stopping = stop.stop_requested();  // asked before the last look into the queue
    result_ = write(queue_.take_all(stop, kFlushPeriod));
    const auto now = std::chrono::steady_clock::now();
    if (!result_ || now - flushed < kFlushPeriod) continue;
    result_ = bag_->flush();
    flushed = now;
  }
  if (result_) result_ = bag_->finish();
  failed_ = !result_;
}

tl::expected<void, std::string> BagThread::write(const std::deque<Received>& messages) {
  for (const Received& received : messages)
    if (auto written = write_one(received); !written) return written;
  return {};
}

tl::expected<void, std::string> BagThread::write_one(const Received& received) {
  const auto& bytes = received.message->bytes;
  std::unique_lock lock(mutex_);
  Count& count = counts_[received.topic];
  bag_topics_.resize(counts_.size(), kNotYet);
  ++count.messages;
  count.bytes += bytes.size();
  if (bag_topics_[received.topic] == kNotYet) {
    const auto added = bag_->add_topic(count.topic);
    if (!added) return tl::unexpected(added.error());
    bag_topics_[received.topic] = *added;
  }
  lock.unlock();
  return bag_->write(bag_topics_[received.topic], {received.time_ns, received.time_ns, bytes});
}

tl::expected<void, std::string> BagThread::finish() {
  thread_.request_stop();
  thread_.join();
  return result_;
}

}  // namespace rds::record
