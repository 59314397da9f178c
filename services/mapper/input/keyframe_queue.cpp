// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/input/keyframe_queue.hpp"

#include <algorithm>

#include "common/messages/conversions.hpp"

namespace rds::mapper {
namespace {

constexpr std::size_t kMaxBoxes = 100;  // messages whose keyframe has not come

std::int64_t stamp_of(const auto& message) {
  return messages::to_nanoseconds(message->header().stamp());
}

}  // namespace

void KeyframeQueue::add(const Images& images, Clock::time_point now) {
  const std::int64_t stamp_ns = stamp_of(images);
  const auto integrated = integrated_.find(stamp_ns);
  if (integrated != integrated_.end() && integrated->second.id >= images->keyframe_id()) return;
  keyframes_.try_emplace(images->keyframe_id(), images, clock_.go_to(stamp_ns).time_ns, now);
  if (keyframes_.size() > capacity_) {
    keyframes_.erase(keyframes_.begin());
    ++dropped_;
  }
  size_ = keyframes_.size();
}

const IntegratedKeyframe* KeyframeQueue::add(const Boxes& boxes) {
  const std::int64_t stamp_ns = stamp_of(boxes);
  const auto integrated = integrated_.find(stamp_ns);
  const auto is_of_boxes = [&](const auto& entry) { return stamp_of(entry.second.images) == stamp_ns; };
  if (integrated != integrated_.end() && !integrated->second.has_boxes &&
      std::ranges::none_of(keyframes_, is_of_boxes)) {
    integrated->second.has_boxes = true;
    return &integrated->second;
  }
  take_boxes(stamp_ns);
  boxes_.emplace_back(stamp_ns, boxes);
  if (boxes_.size() > kMaxBoxes) boxes_.pop_front();
  return nullptr;
}

bool KeyframeQueue::is_ready(Clock::time_point now) const {
  if (keyframes_.empty()) return false;
  const Waiting& oldest = keyframes_.begin()->second;
  const std::int64_t stamp_ns = stamp_of(oldest.images);
  const auto is_there = [&](const StampedBoxes& boxes) { return boxes.first == stamp_ns; };
  if (!wait_.expected || std::ranges::any_of(boxes_, is_there)) return true;
  const auto is_later = [&](const StampedBoxes& boxes) { return boxes.first > stamp_ns; };
  if (wait_.lockstep)
    return std::ranges::any_of(boxes_, is_later);  // its own were lost with a mapper that was killed
  const Waiting& newest = keyframes_.rbegin()->second;
  return now - newest.came > kLongestWait ||
         static_cast<double>(newest.time_ns - oldest.time_ns) * 1e-9 > wait_.timeout_s;
}

KeyframeQueue::Entry KeyframeQueue::take_oldest() {
  const Images images = std::move(keyframes_.begin()->second.images);
  keyframes_.erase(keyframes_.begin());
  size_ = keyframes_.size();
  return {images, take_boxes(stamp_of(images))};
}

KeyframeQueue::Boxes KeyframeQueue::take_boxes(std::int64_t stamp_ns) {
  const auto found = std::ranges::find(boxes_, stamp_ns, &StampedBoxes::first);
  if (found == boxes_.end()) return nullptr;
  Boxes boxes = std::move(found->second);
  boxes_.erase(found);
  return boxes;
}

void KeyframeQueue::forget_keyframes() {
  keyframes_.clear();
  integrated_.clear();
  clock_ = {};
  size_ = 0;
}

void KeyframeQueue::forget_boxes_before(std::int64_t stamp_ns) {
  std::erase_if(boxes_, [&](const StampedBoxes& boxes) { return boxes.first < stamp_ns; });
}

}  // namespace rds::mapper
