// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <utility>

#include "vision_msgs/msg/Detection3DArray.h"

namespace rds::mapper {

/// Boxes whose keyframe has not been integrated yet, by its stamp. When full, what came first is dropped: stamps
/// say nothing about age where a clock was set, or in messages of strangers.
class WaitingBoxes {
 public:
  using Boxes = std::shared_ptr<const vision_msgs::msg::Detection3DArray>;

  /// @param capacity  at least 1.
  explicit WaitingBoxes(std::size_t capacity) : capacity_(capacity) {}

  /// In place of others of the stamp.
  void add(std::int64_t stamp_ns, Boxes boxes) {
    take(stamp_ns);
    waiting_.emplace_back(stamp_ns, std::move(boxes));
    if (waiting_.size() > capacity_) waiting_.pop_front();
  }

  /// @return nullptr if there are none of the stamp.
  Boxes take(std::int64_t stamp_ns) {
    const auto found = std::ranges::find(waiting_, stamp_ns, &Stamped::first);
    if (found == waiting_.end()) return nullptr;
    Boxes boxes = std::move(found->second);
    waiting_.erase(found);
    return boxes;
  }

  void forget_before(std::int64_t stamp_ns) {
    std::erase_if(waiting_, [&](const Stamped& boxes) { return boxes.first < stamp_ns; });
  }

  [[nodiscard]] bool contains(std::int64_t stamp_ns) const {
    return std::ranges::find(waiting_, stamp_ns, &Stamped::first) != waiting_.end();
  }
  [[nodiscard]] bool has_later_than(std::int64_t stamp_ns) const {
    return std::ranges::any_of(waiting_, [&](const Stamped& boxes) { return boxes.first > stamp_ns; });
  }

 private:
  using Stamped = std::pair<std::int64_t, Boxes>;

  std::size_t capacity_;
  std::deque<Stamped> waiting_;  // in the order in which they came
};

}  // namespace rds::mapper
