// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/recording_lists.hpp"

namespace rds::doctor {
namespace {

void add_missing(const image::TumList& list, std::vector<std::filesystem::path>& missing) {
  std::error_code error;
  for (const auto& entry : list.entries)
    if (!std::filesystem::is_regular_file(entry.picture, error)) missing.push_back(entry.picture);
}

}  // namespace

RecordingLists lists_of(const image::TumDataset& dataset) {
  const auto& color = dataset.color_list();
  const auto& depth = dataset.depth_list();
  RecordingLists lists;
  lists.depth_pictures = depth.entries.size();
  lists.repeated = color.repeated + depth.repeated;
  for (const auto& frame : dataset.frames()) {
    lists.frames.push_back(frame.stamp_ns);
    if (frame.has_depth()) lists.depth_after.push_back(frame.depth_stamp_ns - frame.stamp_ns);
  }
  if (dataset.ground_truth()) {
    lists.truth.emplace();
    for (const auto& pose : *dataset.ground_truth()) lists.truth->push_back(pose.stamp_ns);
  }
  add_missing(color, lists.missing);
  add_missing(depth, lists.missing);
  return lists;
}

}  // namespace rds::doctor
