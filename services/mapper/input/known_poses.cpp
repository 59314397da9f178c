// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/input/known_poses.hpp"

#include <algorithm>

namespace rds::mapper {
namespace {
constexpr int kKeyframesPerCorrection = 5;  // local bundle adjustment moves few keyframes, and little
/// Of the tracker's messages. As often a loop closer repeats a correction, so a tracker that has not taken it
/// over by then never will: it follows another loop closer, or the one that told of it is gone.
constexpr int kPatience = 32;
}

void KnownPoses::take(const Message& message, std::vector<geometry::KeyframePose> poses) {
  if (is_local(message)) {
    if (!tracker_.take(message, poses)) return;  // until all are told
    poses = tracker_.poses();
  }
  if (poses.empty()) return;
  if (loops_.is_older(message.loop_instance(), message.loop_revision())) {
    if (!is_local(message) || ++messages_without_loop_ < kPatience) return;
    loops_ = {};
  }
  messages_without_loop_ = 0;
  has_new_loop_ |= loops_.is_newer(message.loop_instance(), message.loop_revision());
  loops_.take(message.loop_instance(), message.loop_revision());
  poses_ = std::move(poses);
  if (is_local(message)) revision_ = message.revision();
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
