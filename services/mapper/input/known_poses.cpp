// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/input/known_poses.hpp"

#include <algorithm>

namespace rds::mapper {
namespace {
constexpr int kKeyframesPerCorrection =
    25;  // local bundle adjustment moves poses little, all of the map is made again
}

void KnownPoses::take(const Message& message, std::vector<geometry::KeyframePose> poses) {
  if (is_local(message)) {
    if (!tracker_.take(message, poses)) return;  // until all are told
    poses = tracker_.poses();
  }
  if (poses.empty() || loops_.is_older(message.loop_instance(), message.loop_revision())) return;
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
