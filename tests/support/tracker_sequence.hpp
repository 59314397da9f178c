// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/trajectory.hpp"
#include "common/image/tum_dataset.hpp"
#include "services/tracker/core/prediction/movable_objects.hpp"
#include "services/tracker/core/tracker.hpp"

namespace rds::test {

struct TrackerSequenceOptions {
  std::size_t mapping_latency = 3;  // frames until a local mapping result is applied
  std::size_t box_latency = 2;      // frames until late boxes are applied
  bool truth_boxes = false;         // people.json's boxes are given with every frame
  std::string detections{};         // detections.jsonl with every frame: keyframes get theirs, late
  bool masks = false;               // compares with masks/
  std::string pictures{};           // folder for pictures of what is removed, every tenth frame
  bool late_boxes = false;          // people.json's boxes are taken back from keyframes
  bool no_mapping = false;
  bool verbose = false;  // one line per frame on stdout
  tracker::Gyroscope gyroscope{};
};

/// Processor times [ms] of one thread: other programs on the machine do not show in them.
struct TrackerTimes {
  std::vector<double> total;         // per frame
  std::vector<double> extract_wall;  // per frame; by the clock
  std::vector<double> mapping, snapshot, apply;
  std::vector<double> joining;  // per keyframe, in a map with submaps
};

/// What was removed, compared with masks/, over the frames with people.
struct RemovalFigures {
  int frames = 0;
  double people = 0;    // sums over frames: share of the people's pixels that was removed,
  double rest = 0;      // … of all others,
  double features = 0;  // and of the features that support the pose the share that lies on people
};

/// The tracker core over a recording, in lockstep, without bus, threads and loop closer.
class TrackerSequence {
 public:
  /// @throws std::runtime_error if boxes are asked for and there is no readable people.json.
  TrackerSequence(const TrackerSequenceOptions& options, const image::TumDataset& dataset,
                  const tracker::TrackerConfig& config);

  /// Tracks frame i of the recording. @throws std::runtime_error if it cannot be read.
  tracker::FrameResult step(std::size_t i);

  /// Poses as estimated live.
  [[nodiscard]] const std::vector<geometry::StampedPose>& live() const { return live_; }
  /// The same frames, each through its reference keyframe's pose now.
  [[nodiscard]] std::vector<geometry::StampedPose> optimized() const;
  [[nodiscard]] const TrackerTimes& times() const { return times_; }
  [[nodiscard]] const std::map<int, int>& frames_by_state() const { return states_; }
  [[nodiscard]] const RemovalFigures& removal() const { return removal_; }
  [[nodiscard]] int keyframes_made() const { return keyframes_; }
  [[nodiscard]] const tracker::Tracker& tracker() const { return tracker_; }

 private:
  struct TrackedPose {
    std::size_t frame;
    std::uint64_t reference;
    geometry::Pose reference_from_camera;
  };
  struct Detected {
    geometry::Box2 box;
    std::string label;
    float score;
    double depth_m;
  };
  struct DueBoxes {
    std::size_t at;
    std::size_t frame;
    std::uint64_t keyframe;
    geometry::Pose map_from_camera;
    geometry::CameraModel camera;
  };
  static std::vector<std::vector<Detected>> read_detections(const std::string& file);

  void record(std::size_t i, const tracker::FrameResult& result);
  void draw_removal(const image::RgbdFrame& frame, std::size_t i,
                    const std::vector<segmentation::ObjectRegion>& regions,
                    const tracker::FrameResult& result) const;
  void compare_removal(std::size_t i, const tracker::FrameResult& result);
  void apply_boxes(const DueBoxes& due);
  [[nodiscard]] std::vector<segmentation::ObjectRegion> regions(std::size_t i,
                                                            const image::RgbdFrame& frame) const;
  void apply_due(std::size_t i);
  void join_submaps();
  void run_mapping(std::size_t i);

  TrackerSequenceOptions options_;
  const image::TumDataset& dataset_;
  tracker::TrackerConfig config_;
  tracker::Tracker tracker_;
  std::vector<std::vector<segmentation::ObjectRegion>> boxes_;  // by frame
  std::vector<std::vector<Detected>> detections_;           // by frame
  tracker::MovableObjects objects_;
  std::deque<DueBoxes> due_boxes_;
  RemovalFigures removal_;
  std::optional<tracker::LocalMappingResult> result_;
  std::size_t result_due_ = 0;
  std::vector<geometry::StampedPose> live_;
  std::vector<TrackedPose> tracked_;
  TrackerTimes times_;
  std::map<int, int> states_;
  int keyframes_ = 0;
};

}  // namespace rds::test
