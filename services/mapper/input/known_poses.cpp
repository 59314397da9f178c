// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/input/known_poses.hpp"

#include <algorithm>

namespace rds::mapper {
namespace {

constexpr int kKeyframesPerCorrection = 5;  // bundle adjustment moves few keyframes, and little

}  // namespace

void KnownPoses::take(const Message& message, const std::vector<geometry::KeyframePose>& poses) {
  if (!table_.take(message, poses)) return;  // until all are told
  poses_ = table_.poses();
  revision_ = message.revision();
  const std::pair loops(message.loop_instance(), message.loop_revision());
  has_new_loop_ |= std::exchange(loops_, loops) != loops;
}

bool KnownPoses::is_correction_due() const {
  return !poses_.empty() && (has_new_loop_ || since_correction_ >= kKeyframesPerCorrection);
}

void KnownPoses::note_correction() {
  has_new_loop_ = false;
  since_correction_ = 0;
}

const geometry::KeyframePose* KnownPoses::find(std::uint64_t id) const {
  const auto found = std::ranges::find(poses_, id, &geometry::KeyframePose::id);
  return found == poses_.end() ? nullptr : &*found;
}

}  // namespace rds::mapper
