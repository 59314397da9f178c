// SPDX-License-Identifier: Apache-2.0
#include "tests/support/tracker_sequence.hpp"

#include <array>
#include <ctime>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace rds::test {
namespace {

using geometry::StampedPose;
using tracker::MovableRegion;

/// Boxes of the people in people.json, by frame.
std::vector<std::vector<MovableRegion>> read_truth_boxes(const std::filesystem::path& dataset) {
  constexpr double kMargin = 8;       // px
  constexpr float kHalfDepth = 0.6F;  // m
  std::ifstream file(dataset / "people.json");
  if (!file) throw std::runtime_error((dataset / "people.json").string() + ": cannot be read");
  std::vector<std::vector<MovableRegion>> all;
  const auto people = nlohmann::json::parse(file);
  for (const auto& frame : people.at("frames")) {
    auto& regions = all.emplace_back();
    for (const auto& person : frame.at("people")) {
      const auto box = person.at("box").get<std::array<double, 4>>();
      const auto distance = person.at("distance").get<float>();
      regions.push_back({{box[0] - kMargin, box[1] - kMargin, box[2] + kMargin, box[3] + kMargin},
                         distance - kHalfDepth,
                         distance + kHalfDepth});
    }
  }
  return all;
}

double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

}  // namespace

TrackerSequence::TrackerSequence(const TrackerSequenceOptions& options, const image::TumDataset& dataset,
                                 const tracker::TrackerConfig& config)
    : options_(options), dataset_(dataset), config_(config), tracker_(config) {
  if (options.truth_boxes || options.late_boxes) boxes_ = read_truth_boxes(dataset.folder());
}

void TrackerSequence::step(std::size_t i) {
  const auto frame = dataset_.load(dataset_.frames()[i]);
  if (!frame) throw std::runtime_error(frame.error());
  apply_due(i);
  const auto start = processor_ms();
  const auto result =
      tracker_.track(*frame, options_.truth_boxes ? boxes_.at(i) : std::vector<MovableRegion>{});
  times_.total.push_back(processor_ms() - start);
  times_.extract_wall.push_back(static_cast<double>(result.times.extract_us) / 1000);
  record(i, result);
  if (!result.keyframe) return;
  ++keyframes_;
  if (options_.late_boxes) due_boxes_.push_back({i + options_.box_latency, i, result.keyframe->id});
  run_mapping(i);
}

void TrackerSequence::record(std::size_t i, const tracker::FrameResult& result) {
  ++states_[static_cast<int>(result.state)];
  if (options_.verbose)
    fmt::print("{} state {} features {} dynamic {} inliers {} kf {} ref {} points {} ms {:.1f} kept {}\n", i,
               static_cast<int>(result.state), result.features, result.dynamic_features, result.inliers,
               result.keyframe.has_value(), result.reference_keyframe_id, tracker_.map().points(),
               times_.total.back(), tracker_.map().keyframes());
  if (!tracker::has_pose(result.state)) return;
  const auto& frame = dataset_.frames()[i];
  live_.push_back({frame.stamp_ns, result.map_from_camera, frame.stamp_text});
  tracked_.push_back({i, result.reference_keyframe_id, result.reference_from_camera});
}

std::vector<StampedPose> TrackerSequence::optimized() const {
  std::vector<StampedPose> poses;
  const auto keyframes = tracker_.keyframe_poses();
  for (const auto& [i, reference, reference_from_camera] : tracked_) {
    const auto& frame = dataset_.frames()[i];
    poses.push_back(
        {frame.stamp_ns, keyframes.at(reference).map_from_camera * reference_from_camera, frame.stamp_text});
  }
  return poses;
}

void TrackerSequence::apply_due(std::size_t i) {
  while (!due_boxes_.empty() && due_boxes_.front().at <= i) {
    tracker_.retract_movable(due_boxes_.front().keyframe, boxes_.at(due_boxes_.front().frame));
    due_boxes_.pop_front();
  }
  if (!result_ || result_due_ > i) return;
  const auto start = processor_ms();
  tracker_.apply(*result_);
  times_.apply.push_back(processor_ms() - start);
  result_.reset();
}

void TrackerSequence::run_mapping(std::size_t i) {
  if (options_.no_mapping || result_) return;
  const auto start = processor_ms();
  const auto job = tracker_.take_mapping_job();
  times_.snapshot.push_back(processor_ms() - start);
  if (!job) return;
  const auto begin = processor_ms();
  result_ = tracker::run_local_mapping(*job, config_.local_mapping);
  times_.mapping.push_back(processor_ms() - begin);
  result_due_ = i + options_.mapping_latency;
}

}  // namespace rds::test
