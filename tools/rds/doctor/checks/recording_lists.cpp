// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/recording_lists.hpp"

namespace rds::doctor {
RecordingLists lists_of(const image::Recording& dataset) {
  RecordingLists lists;
  lists.depth_pictures = dataset.depth_stamps().size();
  lists.repeated = dataset.repeated();
  for (const auto& frame : dataset.frames()) {
    lists.frames.push_back(frame.stamp_ns);
    if (frame.has_depth()) lists.depth_after.push_back(frame.depth_stamp_ns - frame.stamp_ns);
  }
  if (dataset.ground_truth()) {
    lists.truth.emplace();
    for (const auto& pose : *dataset.ground_truth()) lists.truth->push_back(pose.stamp_ns);
  }
  lists.missing = dataset.missing();
  return lists;
}

}  // namespace rds::doctor
