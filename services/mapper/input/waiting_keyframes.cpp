// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/input/waiting_keyframes.hpp"

#include <algorithm>

#include "common/messages/conversions.hpp"

namespace rds::mapper {
namespace {

std::int64_t stamp_of(const WaitingKeyframes::Images& images) {
  return messages::to_nanoseconds(images->header().stamp());
}

}  // namespace

void WaitingKeyframes::add(const Images& images) {
  by_id_.try_emplace(images->keyframe_id(), images, clock_.go_to(stamp_of(images)).time_ns);
  if (by_id_.size() > capacity_) {
    by_id_.erase(by_id_.begin());
    ++dropped_;
  }
  size_ = by_id_.size();
}

WaitingKeyframes::Images WaitingKeyframes::take_oldest() {
  Images images = std::move(by_id_.begin()->second.images);
  by_id_.erase(by_id_.begin());
  size_ = by_id_.size();
  return images;
}

bool WaitingKeyframes::contains(std::int64_t stamp_ns) const {
  return std::ranges::any_of(by_id_, [&](const auto& entry) { return stamp_of(entry.second.images) == stamp_ns; });
}

void WaitingKeyframes::clear() {
  by_id_.clear();
  clock_ = {};
  size_ = 0;
}

}  // namespace rds::mapper
