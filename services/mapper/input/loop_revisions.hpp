// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>

namespace rds::mapper {

/// Which corrections of which loop closer the known keyframe poses contain.
///
/// Revisions count per loop closer's instance: one that was started again begins at 0, and what it finds is
/// newer than all of those before it.
class LoopRevisions {
 public:
  /// Poses that contain this correction were made before their writer knew what we know.
  [[nodiscard]] bool is_older(std::uint64_t instance, std::uint64_t revision) const {
    return instance == instance_ ? revision < revision_
                                 : revision_ > 0 && (instance == 0 || std::ranges::count(earlier_, instance) > 0);
  }
  [[nodiscard]] bool is_newer(std::uint64_t instance, std::uint64_t revision) const {
    return !is_older(instance, revision) && (instance == instance_ ? revision > revision_ : revision > 0);
  }
  void take(std::uint64_t instance, std::uint64_t revision) {
    if (instance != instance_ && instance_ != 0) earlier_.push_back(instance_);
    if (earlier_.size() > kMaxEarlier) earlier_.pop_front();
    instance_ = instance;
    revision_ = revision;
  }

 private:
  static constexpr std::size_t kMaxEarlier = 16;
  std::uint64_t instance_ = 0;
  std::uint64_t revision_ = 0;
  std::deque<std::uint64_t> earlier_;
};

}  // namespace rds::mapper
