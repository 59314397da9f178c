// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tools/rds/record/message_queue.hpp"
#include "tools/recording/bag/bag_writer.hpp"

namespace rds::record {

/// By how much a recorder's threads give way: those who are recorded have the processor first, and their
/// messages wait.
constexpr int kNice = 10;

/// Writes messages into a bag on a thread of its own, and makes them readable twice a second.
class BagThread {
 public:
  struct Count {
    recording::BagTopic topic;
    std::uint64_t messages = 0;
    std::uint64_t bytes = 0;
    std::uint64_t dropped = 0;  // as the disk was too slow
  };

  /// @param queue_bytes  that may wait for the disk.
  BagThread(std::unique_ptr<recording::BagWriter> bag, std::size_t queue_bytes);

  /// Announces a topic (any thread). @return its number.
  std::size_t add_topic(recording::BagTopic topic);
  /// Takes a message over; never waits (any thread).
  void push(Received received);

  /// Whether the bag could not be written: nothing more is.
  [[nodiscard]] bool failed() const { return failed_; }
  /// Writes what waits and completes the file; nothing may be pushed any more. @return or what failed.
  tl::expected<void, std::string> finish();
  [[nodiscard]] std::vector<Count> counts() const;

 private:
  void run(const std::stop_token& stop);
  tl::expected<void, std::string> write(const std::deque<Received>& messages);
  tl::expected<void, std::string> write_one(const Received& received);

  std::unique_ptr<recording::BagWriter> bag_;
  MessageQueue queue_;
  std::atomic<bool> failed_ = false;
  tl::expected<void, std::string> result_;  // the thread's, until it has ended
  std::vector<std::size_t> bag_topics_;     // the thread's: number in the bag, by our number
  mutable std::mutex mutex_;                // of what follows
  std::vector<Count> counts_;               // by number
  std::jthread thread_;                     // last: it uses the others
};

}  // namespace rds::record
