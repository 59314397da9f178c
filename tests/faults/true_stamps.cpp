// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/true_stamps.hpp"

namespace rds::test {

run::Recording with_true_stamps(const run::Recording& recording,
                                const std::map<std::int64_t, std::int64_t>& true_stamps) {
  const auto true_stamp = [&](std::int64_t sent) {
    const auto found = true_stamps.find(sent);
    return found == true_stamps.end() ? sent : found->second;
  };
  run::Recording corrected = recording;
  corrected.frames.clear();
  for (const auto& [stamp, frame] : recording.frames) {
    corrected.frames[true_stamp(stamp)] = frame;
    corrected.frames[true_stamp(stamp)].stamp_ns = true_stamp(stamp);
  }
  corrected.predictions.clear();
  for (const auto& [stamp, boxes] : recording.predictions) corrected.predictions[true_stamp(stamp)] = boxes;
  corrected.detections.clear();
  for (const auto& [stamp, boxes] : recording.detections) corrected.detections[true_stamp(stamp)] = boxes;
  for (auto& [id, keyframe] : corrected.keyframes) keyframe.stamp_ns = true_stamp(keyframe.stamp_ns);
  return corrected;
}

}  // namespace rds::test
