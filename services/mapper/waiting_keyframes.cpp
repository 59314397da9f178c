// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/waiting_keyframes.hpp"

namespace rds::mapper {

void WaitingKeyframes::add(const Images& images) {
  by_id_.emplace(images->keyframe_id(), images);
  if (by_id_.size() > capacity_) {
    by_id_.erase(by_id_.begin());
    ++dropped_;
  }
  size_ = by_id_.size();
}

WaitingKeyframes::Images WaitingKeyframes::take_oldest() {
  Images images = std::move(by_id_.begin()->second);
  by_id_.erase(by_id_.begin());
  size_ = by_id_.size();
  return images;
}

void WaitingKeyframes::clear() {
  by_id_.clear();
  size_ = 0;
}

}  // namespace rds::mapper
