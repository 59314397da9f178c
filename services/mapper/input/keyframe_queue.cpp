// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/input/keyframe_queue.hpp"

#include <algorithm>

#include "common/bus/qos.hpp"
#include "common/messages/conversions.hpp"

namespace rds::mapper {
namespace {

constexpr std::size_t kMaxBoxes = bus::kBoxes.depth;  // messages whose keyframe has not come

std::int64_t stamp_of(const auto& message) {
  return messages::to_nanoseconds(message->header().stamp());
}

}  // namespace

void KeyframeQueue::add(const Images& images, Clock::time_point now) {
  const std::int64_t stamp_ns = stamp_of(images);
  const auto integrated = integrated_.find(stamp_ns);
  if (integrated != integrated_.end() && integrated->second.id >= images->keyframe_id()) return;
  keyframes_.try_emplace(images->keyframe_id(), images);
  if (!newest_ || images->keyframe_id() > newest_->id) newest_ = Newest{images->keyframe_id(), stamp_ns, now};
  if (keyframes_.size() > capacity_) {
    keyframes_.erase(keyframes_.begin());
    ++dropped_;
  }
  size_ = keyframes_.size();
}

const IntegratedKeyframe* KeyframeQueue::add(const Boxes& boxes) {
  const std::int64_t stamp_ns = stamp_of(boxes);
  const auto integrated = integrated_.find(stamp_ns);
  const auto is_of_boxes = [&](const auto& entry) { return stamp_of(entry.second) == stamp_ns; };
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
  const std::int64_t stamp_ns = stamp_of(keyframes_.begin()->second);
  const auto is_there = [&](const StampedBoxes& boxes) { return boxes.first == stamp_ns; };
  if (!wait_.expected || std::ranges::any_of(boxes_, is_there)) return true;
  const auto is_later = [&](const StampedBoxes& boxes) { return boxes.first > stamp_ns; };
  if (wait_.lockstep)
    return std::ranges::any_of(boxes_, is_later);  // its own were lost with a mapper that was killed
  const double newer_by_s = static_cast<double>(newest_->stamp_ns - stamp_ns) * 1e-9;
  return newer_by_s > wait_.timeout_s || newer_by_s < 0 ||  // below 0: a recording that is played again
         now - newest_->came > kLongestWait;
}

KeyframeQueue::Entry KeyframeQueue::take_oldest() {
  const Images images = std::move(keyframes_.begin()->second);
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
  newest_.reset();
  size_ = 0;
}

void KeyframeQueue::forget_boxes_before(std::int64_t stamp_ns) {
  std::erase_if(boxes_, [&](const StampedBoxes& boxes) { return boxes.first < stamp_ns; });
}

}  // namespace rds::mapper
