// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>

#include "common/time/continuous_time.hpp"
#include "rds_msgs/msg/KeyFrameImages.h"

namespace rds::mapper {

/// Keyframes in order of their ids, until their boxes have come or a pause is over. When full, the oldest is
/// dropped and counted, as in an Inbox. size() and dropped() may be read by any thread.
class WaitingKeyframes {
 public:
  using Images = std::shared_ptr<const rds_msgs::msg::KeyFrameImages>;

  /// @param capacity  at least 1.
  explicit WaitingKeyframes(std::size_t capacity) : capacity_(capacity) {}

  /// One whose id waits already changes nothing.
  void add(const Images& images);
  /// There must be one.
  Images take_oldest();
  void clear();

  [[nodiscard]] bool empty() const { return by_id_.empty(); }
  [[nodiscard]] const Images& oldest() const { return by_id_.begin()->second.images; }
  [[nodiscard]] bool contains(std::int64_t stamp_ns) const;
  /// Time from the oldest to the newest one; it goes on where stamps go back. There must be one.
  [[nodiscard]] std::int64_t span_ns() const {
    return by_id_.rbegin()->second.time_ns - by_id_.begin()->second.time_ns;
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  struct Waiting {
    Images images;
    std::int64_t time_ns;
  };

  std::size_t capacity_;
  time::ContinuousTime clock_;
  std::map<std::uint64_t, Waiting> by_id_;
  std::atomic<std::size_t> size_ = 0;
  std::atomic<std::uint64_t> dropped_ = 0;
};

}  // namespace rds::mapper
